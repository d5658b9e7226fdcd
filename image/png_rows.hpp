// A PNG that is written row by row: pictures that memory has no room for. RGBA8 as image/png.hpp
// has it. Not in a browser, which has no zlib.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "base/output.hpp"
#include "image/image.hpp"

namespace tureen {

/// The compressor and the checksums are zlib's; of PNG itself this needs three kinds of chunk and
/// the row filters (PNG specification, 3rd edition, sections 5 and 9).
class PngRows {
 public:
  /// Writes the header. `output` must outlive this, and is not committed by it. The sides are at
  /// least 1.
  PngRows(Output& output, int width, int height);
  ~PngRows();
  PngRows(const PngRows&) = delete;
  PngRows& operator=(const PngRows&) = delete;

  /// The next rows from the top, of the picture's width. Throws OutputError.
  void append(const Image8& rows);

  /// Writes what is left; asserts that all rows were appended. Throws OutputError.
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
