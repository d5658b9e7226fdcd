// Writes a PNG row by row, for images that exceed the memory and for 16 bits a channel. Values are
// stored as they are, as in image/png.hpp. Not available in a browser, which has no zlib.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/output.hpp"
#include "image/image.hpp"

namespace tureen {

enum class PngPixels { rgba8, grey16, rgb16 };

/// zlib provides the compressor and the checksums. The class writes three kinds of chunk and the
/// row filters (PNG specification, 3rd edition, sections 5 and 9).
class PngRows {
 public:
  /// Writes the header. `output` must outlive this object, which does not commit it. The sides are
  /// at least 1.
  PngRows(Output& output, int width, int height, PngPixels pixels = PngPixels::rgba8);
  ~PngRows();
  PngRows(const PngRows&) = delete;
  PngRows& operator=(const PngRows&) = delete;

  /// Appends the next rows from the top, of the image's width. Throws OutputError.
  void append(const Image8& rows);
  /// The same for 16 bits a channel: one value a pixel or three.
  void append(std::span<const std::uint16_t> values);

  /// Writes the rest. Asserts that all rows were appended. Throws OutputError.
  void finish();

 private:
  struct Compressor;

  void append_row(const std::uint8_t* row);
  void compress(const std::vector<std::uint8_t>& bytes, int flush);
  void write_chunk(const char* type, const std::uint8_t* bytes, std::size_t size);

  Output& output_;
  int rows_left_;
  std::size_t pixel_bytes_;
  std::unique_ptr<Compressor> compressor_;
  std::vector<std::uint8_t> previous_, filtered_, candidate_;
};

}  // namespace tureen
