#include "image/png_rows.hpp"

#include <zlib.h>

#include <array>
#include <cassert>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <new>

#include "image/png_filters.hpp"

namespace tureen {

namespace {

constexpr std::size_t chunk_bytes = 1 << 18;  // maximum of compressed data

std::array<std::uint8_t, 4> big_endian(std::uint32_t value) {
  return {std::uint8_t(value >> 24), std::uint8_t(value >> 16), std::uint8_t(value >> 8),
          std::uint8_t(value)};
}

using Row = std::vector<std::uint8_t>;

/// Writes the filter's number and the differences between the row and its prediction. Returns the
/// sum of their magnitudes, the criterion that the specification recommends (section 12.7).
template <int filter>
std::uint64_t filter_row(const std::uint8_t* row, std::size_t pixel_bytes, const Row& above,
                         Row& out) {
  out[0] = std::uint8_t(filter);
  std::uint64_t sum = 0;
  const auto add = [&](std::size_t i, int left, int above_left) {
    out[1 + i] = std::uint8_t(row[i] - predicted<filter>(left, above[i], above_left));
    sum += std::uint64_t(std::abs(int(std::int8_t(out[1 + i]))));
  };
  for (std::size_t i = 0; i < pixel_bytes; ++i) add(i, 0, 0);
  for (std::size_t i = pixel_bytes; i < above.size(); ++i)
    add(i, row[i - pixel_bytes], above[i - pixel_bytes]);
  return sum;
}

constexpr std::array filters = {filter_row<0>, filter_row<1>, filter_row<2>, filter_row<3>,
                                filter_row<4>};

/// Bits a channel, and the colour type of the specification.
struct Format {
  std::size_t pixel_bytes;
  std::uint8_t bits, color_type;
};

Format format_of(PngPixels pixels) {
  switch (pixels) {
    case PngPixels::grey16:
      return {2, 16, 0};
    case PngPixels::rgb16:
      return {6, 16, 2};
    default:
      return {4, 8, 6};
  }
}

}  // namespace

struct PngRows::Compressor {
  z_stream stream{};
  std::vector<std::uint8_t> packed = std::vector<std::uint8_t>(chunk_bytes);

  Compressor() {
    // Same level as in image/png.cpp.
    if (deflateInit(&stream, 4) != Z_OK) throw std::bad_alloc();
  }
  ~Compressor() { deflateEnd(&stream); }
};

PngRows::PngRows(Output& output, int width, int height, PngPixels pixels)
    : output_(output),
      rows_left_(height),
      pixel_bytes_(format_of(pixels).pixel_bytes),
      compressor_(std::make_unique<Compressor>()),
      previous_(std::size_t(width) * pixel_bytes_),
      filtered_(previous_.size() + 1),
      candidate_(previous_.size() + 1) {
  assert(width > 0 && height > 0);
  output_.write(std::string_view("\x89PNG\r\n\x1a\n", 8));
  // Width, height, bits, colour type, deflate, adaptive filters, no interlacing.
  const Format format = format_of(pixels);
  std::array<std::uint8_t, 13> header{0, 0, 0, 0, 0, 0, 0, 0, format.bits, format.color_type};
  std::memcpy(header.data(), big_endian(std::uint32_t(width)).data(), 4);
  std::memcpy(header.data() + 4, big_endian(std::uint32_t(height)).data(), 4);
  write_chunk("IHDR", header.data(), header.size());
}

PngRows::~PngRows() = default;

void PngRows::append(const Image8& rows) {
  assert(std::size_t(rows.width) * sizeof(glm::u8vec4) == previous_.size() &&
         rows.height <= rows_left_);
  for (int y = 0; y < rows.height; ++y)
    append_row(reinterpret_cast<const std::uint8_t*>(&rows.at(0, y)));
  rows_left_ -= rows.height;
}

void PngRows::append(std::span<const std::uint16_t> values) {
  const std::size_t row_values = previous_.size() / 2;
  assert(pixel_bytes_ != 4 && values.size() % row_values == 0);
  std::vector<std::uint8_t> row;
  for (; !values.empty(); values = values.subspan(row_values)) {
    row.clear();
    for (const std::uint16_t value : values.first(row_values)) {
      row.push_back(std::uint8_t(value >> 8));
      row.push_back(std::uint8_t(value));
    }
    append_row(row.data());
    --rows_left_;
  }
}

void PngRows::finish() {
  assert(rows_left_ == 0);
  compress({}, Z_FINISH);
  write_chunk("IEND", nullptr, 0);
}

void PngRows::append_row(const std::uint8_t* row) {
  std::uint64_t least = std::numeric_limits<std::uint64_t>::max();
  for (const auto filter : filters) {
    const std::uint64_t sum = filter(row, pixel_bytes_, previous_, candidate_);
    if (sum >= least) continue;
    least = sum;
    filtered_.swap(candidate_);
  }
  std::memcpy(previous_.data(), row, previous_.size());
  compress(filtered_, Z_NO_FLUSH);
}

void PngRows::compress(const std::vector<std::uint8_t>& bytes, int flush) {
  z_stream& stream = compressor_->stream;
  std::vector<std::uint8_t>& packed = compressor_->packed;
  // zlib only reads through this pointer, although its type is not const.
  stream.next_in = const_cast<std::uint8_t*>(bytes.data());
  stream.avail_in = uInt(bytes.size());
  int result = Z_OK;
  do {
    // A chunk is written only when it is full; the next rows continue it.
    if (stream.avail_out == 0 || !stream.next_out) {
      if (stream.next_out) write_chunk("IDAT", packed.data(), packed.size());
      stream.next_out = packed.data();
      stream.avail_out = uInt(packed.size());
    }
    result = deflate(&stream, flush);
    assert(result == Z_OK || result == Z_STREAM_END || result == Z_BUF_ERROR);
  } while (flush == Z_FINISH ? result != Z_STREAM_END
                             : stream.avail_in > 0 || stream.avail_out == 0);
  if (flush == Z_FINISH) write_chunk("IDAT", packed.data(), packed.size() - stream.avail_out);
}

void PngRows::write_chunk(const char* type, const std::uint8_t* bytes, std::size_t size) {
  uLong sum = crc32(0, reinterpret_cast<const Bytef*>(type), 4);
  if (size > 0) sum = crc32(sum, bytes, uInt(size));
  output_.write_value(big_endian(std::uint32_t(size)));
  output_.write(std::string_view(type, 4));
  output_.write(std::as_bytes(std::span(bytes, size)));
  output_.write_value(big_endian(std::uint32_t(sum)));
}

}  // namespace tureen
