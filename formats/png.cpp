#include "formats/png.hpp"

#include <algorithm>
#include <array>
#include <climits>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>
#include <string_view>
#include <utility>

#include "formats/deflate.hpp"

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#define STBI_NO_HDR
#define STBI_NO_LINEAR
#include <stb/stb_image.h>

namespace tureen {

Image8 decode_image(std::span<const std::byte> bytes, const std::string& name) {
  const auto fail = [&](const std::string& reason) -> void {
    throw InputError({name, {}, {}}, reason);
  };
  if (bytes.size() > std::size_t(INT_MAX)) fail("an image of over 2 GiB");
  const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
  const int size = static_cast<int>(bytes.size());
  int width = 0, height = 0, channels = 0;
  if (!stbi_info_from_memory(data, size, &width, &height, &channels))
    fail(std::string("not a PNG or JPEG image: ") + stbi_failure_reason());
  if (width < 1 || height < 1 || width > max_image_side || height > max_image_side ||
      std::size_t(width) * height > max_image_pixels)
    fail("an image of " + std::to_string(width) + " x " + std::to_string(height) +
         " pixels is beyond what we read");
  const std::unique_ptr<stbi_uc, decltype(&std::free)> pixels(
      stbi_load_from_memory(data, size, &width, &height, &channels, 4), &std::free);
  if (!pixels) fail(std::string("the image is damaged: ") + stbi_failure_reason());
  Image8 image(width, height);
  std::memcpy(image.pixels.data(), pixels.get(), image.pixels.size() * 4);
  return image;
}

Image8 read_image(Input& input) { return decode_image(input.read_rest(), input.name()); }

namespace {

constexpr std::size_t pixel_bytes = 4;
constexpr int filter_count = 5;

/// The predictor of the PNG specification, 9.4: of left, up and upper left the one nearest to
/// left + up - upper left.
std::uint8_t paeth(int left, int up, int corner) {
  const int to_left = std::abs(up - corner), to_up = std::abs(left - corner);
  const int to_corner = std::abs(left + up - 2 * corner);
  const int vertical = to_up <= to_corner ? up : corner;
  return static_cast<std::uint8_t>(to_left <= to_up && to_left <= to_corner ? left : vertical);
}

/// Writes `row` less what `filter` predicts from the bytes before it and above it. Both rows are
/// preceded by one black pixel.
template <class Predict>
void filter_row(const std::uint8_t* row, const std::uint8_t* above, std::size_t size,
                std::uint8_t* out, Predict&& predict) {
  for (std::size_t i = 0; i < size; ++i)
    out[i] = static_cast<std::uint8_t>(
        row[i] - predict(row[i - pixel_bytes], above[i], above[i - pixel_bytes]));
}

void filter_row(int filter, const std::uint8_t* row, const std::uint8_t* above, std::size_t size,
                std::uint8_t* out) {
  const auto apply = [&](auto&& predict) { filter_row(row, above, size, out, predict); };
  switch (filter) {
    case 0:
      return apply([](int, int, int) { return 0; });
    case 1:
      return apply([](int left, int, int) { return left; });
    case 2:
      return apply([](int, int up, int) { return up; });
    case 3:
      return apply([](int left, int up, int) { return (left + up) >> 1; });
    default:
      return apply(paeth);
  }
}

/// Differences count by their distance from zero: the less of it, the fewer bits, as a rule of
/// thumb that the PNG specification recommends (12.7).
std::uint64_t cost(const std::uint8_t* bytes, std::size_t size) {
  std::uint64_t total = 0;
  while (size > 0) {
    // In 32 bits, so that compilers take many bytes at once.
    const std::size_t part = std::min<std::size_t>(size, 1 << 16);
    std::uint32_t sum = 0;
    for (std::size_t i = 0; i < part; ++i) sum += std::min(bytes[i], std::uint8_t(0 - bytes[i]));
    total += sum;
    bytes += part;
    size -= part;
  }
  return total;
}

/// Each row filtered by whichever filter costs least, after a byte that names it.
std::vector<std::uint8_t> filtered_rows(const Image8& image) {
  const std::size_t size = std::size_t(image.width) * pixel_bytes;
  std::vector<std::uint8_t> row(pixel_bytes + size), above(row), tried(size), all;
  all.reserve((1 + size) * std::size_t(image.height));
  for (int y = 0; y < image.height; ++y) {
    std::memcpy(&row[pixel_bytes], &image.pixels[std::size_t(y) * std::size_t(image.width)], size);
    const std::size_t begin = all.size();
    all.resize(begin + 1 + size);
    std::uint64_t least = std::numeric_limits<std::uint64_t>::max();
    for (int filter = 0; filter < filter_count; ++filter) {
      filter_row(filter, &row[pixel_bytes], &above[pixel_bytes], size, tried.data());
      const std::uint64_t costs = cost(tried.data(), size);
      if (costs >= least) continue;
      least = costs;
      all[begin] = static_cast<std::uint8_t>(filter);
      std::memcpy(&all[begin + 1], tried.data(), size);
    }
    std::swap(row, above);
  }
  return all;
}

constexpr std::array<std::uint32_t, 256> make_crc_table() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t n = 0; n < 256; ++n) {
    std::uint32_t c = n;
    for (int k = 0; k < 8; ++k) c = c & 1 ? 0xedb88320u ^ c >> 1 : c >> 1;
    table[n] = c;
  }
  return table;
}
constexpr auto crc_table = make_crc_table();

void put_big_endian(std::vector<std::byte>& out, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8)
    out.push_back(static_cast<std::byte>(value >> shift));
}

void put_chunk(std::vector<std::byte>& out, std::string_view type,
               std::span<const std::byte> content) {
  put_big_endian(out, static_cast<std::uint32_t>(content.size()));
  const std::size_t begin = out.size();
  const auto type_bytes = std::as_bytes(std::span(type));
  out.insert(out.end(), type_bytes.begin(), type_bytes.end());
  out.insert(out.end(), content.begin(), content.end());
  std::uint32_t crc = 0xffffffffu;
  for (std::size_t i = begin; i < out.size(); ++i)
    crc = crc_table[(crc ^ std::to_integer<std::uint32_t>(out[i])) & 0xff] ^ crc >> 8;
  put_big_endian(out, ~crc);
}

}  // namespace

std::vector<std::byte> encode_png(const Image8& image) {
  constexpr std::string_view signature = "\x89PNG\r\n\x1a\n";
  const auto signature_bytes = std::as_bytes(std::span(signature));
  std::vector<std::byte> png(signature_bytes.begin(), signature_bytes.end());
  std::vector<std::byte> header;
  put_big_endian(header, static_cast<std::uint32_t>(image.width));
  put_big_endian(header, static_cast<std::uint32_t>(image.height));
  // 8 bits, RGBA, deflated, adaptive filters, not interlaced.
  for (const int byte : {8, 6, 0, 0, 0}) header.push_back(static_cast<std::byte>(byte));
  put_chunk(png, "IHDR", header);
  const std::vector<std::uint8_t> rows = filtered_rows(image);
  put_chunk(png, "IDAT", zlib_compress(std::as_bytes(std::span(rows))));
  put_chunk(png, "IEND", {});
  return png;
}

}  // namespace tureen
