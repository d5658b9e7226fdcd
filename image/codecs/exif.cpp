#include "image/codecs/exif.hpp"

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <utility>

namespace tureen {

namespace {

using FileBytes = std::span<const std::byte>;

/// The number at `at`; 0 beyond the end.
std::uint32_t number(FileBytes bytes, std::size_t at, std::size_t size, bool big_endian) {
  if (at > bytes.size() || bytes.size() - at < size) return 0;
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < size; ++i)
    value |= std::to_integer<std::uint32_t>(bytes[at + i]) << 8 * (big_endian ? size - 1 - i : i);
  return value;
}

bool begins_with(FileBytes bytes, std::string_view text) {
  return bytes.size() >= text.size() &&
         std::equal(text.begin(), text.end(), bytes.begin(),
                    [](char c, std::byte b) { return std::byte(c) == b; });
}

/// The orientation in a TIFF structure: a list of entries of 12 bytes.
int orientation_of(FileBytes tiff) {
  const bool big_endian = begins_with(tiff, "MM");
  if (!big_endian && !begins_with(tiff, "II")) return 1;
  const std::size_t list = number(tiff, 4, 4, big_endian);
  const std::size_t entries = number(tiff, list, 2, big_endian);
  for (std::size_t i = 0; i < entries; ++i) {
    const std::size_t entry = list + 2 + 12 * i;
    if (number(tiff, entry, 2, big_endian) != 274) continue;
    const std::uint32_t value = number(tiff, entry + 8, 2, big_endian);
    return value >= 1 && value <= 8 ? int(value) : 1;
  }
  return 1;
}

}  // namespace

int exif_orientation(FileBytes file) {
  using namespace std::string_view_literals;
  if (number(file, 0, 2, true) != 0xffd8) return 1;
  // Segments: a marker, and a length that includes itself. EXIF precedes the image (marker 0xffda).
  for (std::size_t at = 2; at + 4 <= file.size();) {
    const std::uint32_t marker = number(file, at, 2, true), length = number(file, at + 2, 2, true);
    if (marker < 0xff00 || marker == 0xffda || length < 2) return 1;
    const FileBytes segment =
        file.subspan(at + 4, std::min<std::size_t>(length - 2, file.size() - at - 4));
    if (marker == 0xffe1 && begins_with(segment, "Exif\0\0"sv))
      return orientation_of(segment.subspan(6));
    at += 2 + length;
  }
  return 1;
}

Image8 turned(const Image8& image, int orientation) {
  if (orientation <= 1) return image;
  const int width = image.width, height = image.height;
  Image8 result = swaps_sides(orientation) ? Image8(height, width) : Image8(width, height);
  // From the first row's and column's side in the standard's table.
  const bool from_right =
      orientation == 2 || orientation == 3 || orientation == 7 || orientation == 8;
  const bool from_bottom =
      orientation == 3 || orientation == 4 || orientation == 6 || orientation == 7;
  for (int y = 0; y < result.height; ++y)
    for (int x = 0; x < result.width; ++x) {
      int column = x, row = y;
      if (swaps_sides(orientation)) std::swap(column, row);
      result.at(x, y) =
          image.at(from_right ? width - 1 - column : column, from_bottom ? height - 1 - row : row);
    }
  return result;
}

}  // namespace tureen
