#include "image/deflated_png.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "image/png.hpp"
#include "image/png_chunks.hpp"
#include "image/png_filters.hpp"

namespace tureen {

namespace {

/// Bytes in a vector of the processor; GCC and Clang know the attribute.
template <int size>
struct Bytes {
  using Vector __attribute__((vector_size(size))) = std::uint8_t;
  Vector values = {};
  static Bytes load(const std::byte* from) {
    Bytes bytes;
    std::memcpy(&bytes.values, from, sizeof bytes.values);
    return bytes;
  }
  void store(std::byte* to) const { std::memcpy(to, &values, sizeof values); }
};

/// A pixel depends on the one before, so pixels are computed one by one.
template <int filter>
void unfilter_pixels(std::span<std::byte> row, const std::byte* above) {
  using Pixel = Bytes<4>;
  Pixel left, up_left;
  for (std::size_t i = 0; i < row.size(); i += sizeof(Pixel)) {
    Pixel pixel = Pixel::load(&row[i]);
    const Pixel up = Pixel::load(above + i);
    if constexpr (filter == 1) {
      pixel.values += left.values;
    } else {
      for (int c = 0; c < 4; ++c)
        pixel.values[c] += predicted<filter>(left.values[c], up.values[c], up_left.values[c]);
    }
    pixel.store(&row[i]);
    left = pixel;
    up_left = up;
  }
}

void add_above(std::span<std::byte> row, const std::byte* above) {
  using Block = Bytes<16>;
  std::size_t i = 0;
  for (; i + sizeof(Block) <= row.size(); i += sizeof(Block)) {
    Block block = Block::load(&row[i]);
    block.values += Block::load(above + i).values;
    block.store(&row[i]);
  }
  for (; i < row.size(); ++i)
    row[i] = std::byte(std::to_integer<int>(row[i]) + std::to_integer<int>(above[i]));
}

bool unfilter_row(std::byte filter, std::span<std::byte> row, const std::byte* above) {
  switch (std::to_integer<int>(filter)) {
    case 0:
      return true;
    case 1:
      unfilter_pixels<1>(row, above);
      return true;
    case 2:
      add_above(row, above);
      return true;
    case 3:
      unfilter_pixels<3>(row, above);
      return true;
    case 4:
      unfilter_pixels<4>(row, above);
      return true;
    default:
      return false;
  }
}

/// Reads the header; false if it belongs to another kind of image.
bool read_header(std::span<const std::byte> header, DeflatedPng& png) {
  // Width and height, then bits, colour type, deflate, adaptive filters, no interlacing.
  constexpr std::byte rest[] = {std::byte(8), std::byte(6), std::byte(0), std::byte(0),
                                std::byte(0)};
  if (header.size() != 8 + sizeof rest || std::memcmp(&header[8], rest, sizeof rest) != 0)
    return false;
  const std::uint32_t width = png_number(header), height = png_number(header.subspan(4));
  if (width < 1 || height < 1 || std::max(width, height) > std::uint32_t(max_image_side) ||
      std::uint64_t(width) * height > max_image_pixels)
    return false;
  png.width = int(width);
  png.height = int(height);
  return true;
}

}  // namespace

std::optional<DeflatedPng> deflated_png(std::span<const std::byte> file) {
  if (!is_png(file) || png_damage(file)) return std::nullopt;
  DeflatedPng png;
  for (std::span<const std::byte> rest = file.subspan(png_signature_bytes);
       !begins_with_last_chunk(rest);) {
    const PngChunk chunk = first_png_chunk(rest);
    rest = rest.subspan(chunk.file_bytes());
    if (png.width == 0) {
      if (!chunk.is("IHDR") || !read_header(chunk.data, png)) return std::nullopt;
    } else if (chunk.is("IDAT")) {
      png.pieces.push_back(chunk.data);
    } else if (chunk.defines_image()) {
      return std::nullopt;  // a palette, a transparent colour, or a second header
    }
  }
  return png.width > 0 ? std::optional(std::move(png)) : std::nullopt;
}

bool unfilter(std::span<std::byte> stream, int width) {
  const std::size_t row_bytes = png_row_bytes(width);
  const std::vector<std::byte> none(row_bytes);  // above the first row
  const std::byte* above = none.data();
  for (; !stream.empty(); stream = stream.subspan(row_bytes)) {
    const std::span<std::byte> row = stream.subspan(1, row_bytes - 1);
    if (!unfilter_row(stream[0], row, above)) return false;
    above = row.data();
  }
  return true;
}

}  // namespace tureen
