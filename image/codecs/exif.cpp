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

/// The TIFF structure of the EXIF data; empty if there is none.
FileBytes tiff_of(FileBytes file) {
  using namespace std::string_view_literals;
  if (number(file, 0, 2, true) != 0xffd8) return {};
  // Segments: a marker, and a length that includes itself. EXIF precedes the image (marker 0xffda).
  for (std::size_t at = 2; at + 4 <= file.size();) {
    const std::uint32_t marker = number(file, at, 2, true), length = number(file, at + 2, 2, true);
    if (marker < 0xff00 || marker == 0xffda || length < 2) return {};
    const FileBytes segment =
        file.subspan(at + 4, std::min<std::size_t>(length - 2, file.size() - at - 4));
    if (marker == 0xffe1 && begins_with(segment, "Exif\0\0"sv)) return segment.subspan(6);
    at += 2 + length;
  }
  return {};
}

/// Where the value of a tag stands in a list of entries of 12 bytes; 0: nowhere.
std::size_t value_of(FileBytes tiff, std::size_t list, std::uint32_t tag, bool big_endian) {
  const std::size_t entries = number(tiff, list, 2, big_endian);
  for (std::size_t i = 0; i < entries; ++i)
    if (number(tiff, list + 2 + 12 * i, 2, big_endian) == tag) return list + 2 + 12 * i + 8;
  return 0;
}

}  // namespace

int exif_orientation(FileBytes file) {
  const FileBytes tiff = tiff_of(file);
  const bool big_endian = begins_with(tiff, "MM");
  if (!big_endian && !begins_with(tiff, "II")) return 1;
  const std::size_t at = value_of(tiff, number(tiff, 4, 4, big_endian), 274, big_endian);
  const std::uint32_t value = at ? number(tiff, at, 2, big_endian) : 1;
  return value >= 1 && value <= 8 ? int(value) : 1;
}

std::optional<double> exif_focal_length(FileBytes file) {
  const FileBytes tiff = tiff_of(file);
  const bool big_endian = begins_with(tiff, "MM");
  if (!big_endian && !begins_with(tiff, "II")) return std::nullopt;
  // The first list points to that of the photograph's settings, and its entry to a quotient.
  std::size_t at = number(tiff, 4, 4, big_endian);
  for (const std::uint32_t tag : {0x8769u, 0x920au}) {
    const std::size_t value = value_of(tiff, at, tag, big_endian);
    if (value == 0) return std::nullopt;
    at = number(tiff, value, 4, big_endian);
    if (at == 0) return std::nullopt;  // the file ends before
  }
  const double above = number(tiff, at, 4, big_endian), below = number(tiff, at + 4, 4, big_endian);
  if (!(above > 0 && below > 0)) return std::nullopt;
  return above / below;
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

glm::ivec2 stored_top(int orientation) {
  if (orientation <= 2) return {0, 1};
  if (orientation <= 4) return {0, -1};
  return {orientation <= 6 ? -1 : 1, 0};
}

}  // namespace tureen
