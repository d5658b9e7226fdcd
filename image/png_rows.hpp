// Writes a PNG row by row, for images that exceed the memory. RGBA8, as in image/png.hpp. Not
// available in a browser, which has no zlib.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "base/output.hpp"
#include "image/image.hpp"

namespace tureen {

/// zlib provides the compressor and the checksums. The class writes three kinds of chunk and the
/// row filters (PNG specification, 3rd edition, sections 5 and 9).
class PngRows {
 public:
  /// Writes the header. `output` must outlive this object, which does not commit it. The sides are
  /// at least 1.
  PngRows(Output& output, int width, int height);
  ~PngRows();
  PngRows(const PngRows&) = delete;
  PngRows& operator=(const PngRows&) = delete;

  /// Appends the next rows from the top, of the image's width. Throws OutputError.
  void append(const Image8& rows);

  /// Writes the rest. Asserts that all rows were appended. Throws OutputError.
  void finish();

 private:
  struct Compressor;

  void append_row(const glm::u8vec4* row);
  void compress(const std::vector<std::uint8_t>& bytes, int flush);
  void write_chunk(const char* type, const std::uint8_t* bytes, std::size_t size);

  Output& output_;
  int rows_left_;
  std::unique_ptr<Compressor> compressor_;
  std::vector<std::uint8_t> previous_, filtered_, candidate_;
};

}  // namespace tureen
