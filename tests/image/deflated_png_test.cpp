// PNG files that the caller inflates have the same pixels as those that stb_image reads.
#include "image/deflated_png.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "image/png.hpp"
#include "image/png_filters.hpp"
#include "tests/image/png_sums.hpp"
#include "tests/support/inflated.hpp"

namespace tureen {
namespace deflated_png_test {

using Bytes = std::vector<std::byte>;

Image8 noise(int width, int height) {
  std::mt19937 random(3);
  Image8 image(width, height);
  for (glm::u8vec4& pixel : image.pixels)
    for (int c = 0; c < 4; ++c) pixel[c] = std::uint8_t(random());
  return image;
}

std::vector<glm::u8vec4> pixels_of(const DeflatedPng& png) {
  Bytes stream = test::inflated(png);
  EXPECT_TRUE(unfilter(stream, png.width));
  std::vector<glm::u8vec4> pixels(std::size_t(png.width) * std::size_t(png.height));
  for (int y = 0; y < png.height; ++y)
    std::memcpy(&pixels[std::size_t(y) * std::size_t(png.width)],
                &stream[std::size_t(y) * png_row_bytes(png.width) + 1], 4 * std::size_t(png.width));
  return pixels;
}

TEST(DeflatedPng, HasThePixelsOfTheImage) {
  for (const auto& [width, height] : {std::pair(1, 1), {1, 9}, {9, 1}, {5, 7}, {300, 211}}) {
    const Image8 image = noise(width, height);
    const Bytes file = encode_png(image);
    const auto png = deflated_png(file);
    ASSERT_TRUE(png);
    EXPECT_EQ(png->width, width);
    EXPECT_EQ(png->height, height);
    EXPECT_TRUE(pixels_of(*png) == image.pixels) << width << " x " << height;
  }
}

/// The rows of an image with this filter; `filter` is also a template's argument.
template <int filter>
void append_filtered(const Image8& image, int y, Bytes& stream) {
  stream.push_back(std::byte(filter));
  const auto value = [&](int x, int row, int c) {
    return x < 0 || row < 0 ? 0 : int(image.at(x, row)[c]);
  };
  for (int x = 0; x < image.width; ++x)
    for (int c = 0; c < 4; ++c)
      stream.push_back(
          std::byte(value(x, y, c) - predicted<filter>(value(x - 1, y, c), value(x, y - 1, c),
                                                       value(x - 1, y - 1, c))));
}

TEST(DeflatedPng, ReversesEveryFilter) {
  constexpr int width = 7;  // a row is no multiple of a vector
  const Image8 image = noise(width, 15);
  for (int first = 0; first < 5; ++first) {  // the first row has each filter once
    Bytes stream;
    constexpr std::array filters = {append_filtered<0>, append_filtered<1>, append_filtered<2>,
                                    append_filtered<3>, append_filtered<4>};
    for (int y = 0; y < image.height; ++y)
      filters[std::size_t(first + y) % filters.size()](image, y, stream);
    ASSERT_TRUE(unfilter(stream, width));
    for (int y = 0; y < image.height; ++y)
      EXPECT_EQ(
          std::memcmp(&stream[std::size_t(y) * (1 + 4 * width) + 1], &image.at(0, y), 4 * width), 0)
          << "row " << y << ", first filter " << first;
  }
}

TEST(DeflatedPng, RejectsAnUnknownFilter) {
  Bytes stream(2 * (1 + 4 * 3));
  EXPECT_TRUE(unfilter(stream, 3));
  stream[1 + 4 * 3] = std::byte{5};
  EXPECT_FALSE(unfilter(stream, 3));
}

/// A file of these chunks, with right checksums.
Bytes file_of(const std::vector<std::pair<std::string, Bytes>>& chunks) {
  Bytes file;
  const auto append = [&](const void* data, std::size_t size) {
    const auto* bytes = static_cast<const std::byte*>(data);
    file.insert(file.end(), bytes, bytes + size);
  };
  append("\x89PNG\r\n\x1a\n", 8);
  for (const auto& [type, data] : chunks) {
    for (int shift = 24; shift >= 0; shift -= 8) file.push_back(std::byte(data.size() >> shift));
    append(type.data(), 4);
    append(data.data(), data.size());
    append("sum?", 4);
  }
  return test::with_png_sums(std::move(file));
}

/// A header: width, height, bits, colour type, and three methods.
Bytes header(std::uint32_t width, std::uint32_t height, int bits = 8, int color = 6,
             int interlaced = 0) {
  Bytes bytes;
  for (const std::uint32_t side : {width, height})
    for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(std::byte(side >> shift));
  for (const int value : {bits, color, 0, 0, interlaced}) bytes.push_back(std::byte(value));
  return bytes;
}

TEST(DeflatedPng, GathersThePiecesOfTheStream) {
  const Image8 image = noise(40, 30);
  const Bytes file = encode_png(image);
  const auto whole = deflated_png(file);
  ASSERT_TRUE(whole);
  ASSERT_EQ(whole->pieces.size(), 1u);
  const Bytes stream(whole->pieces[0].begin(), whole->pieces[0].end());
  const Bytes parts = file_of({{"IHDR", header(40, 30)},
                               {"tEXt", Bytes(5)},
                               {"IDAT", Bytes(stream.begin(), stream.begin() + 100)},
                               {"IDAT", {}},
                               {"IDAT", Bytes(stream.begin() + 100, stream.end())},
                               {"IEND", {}}});
  const auto png = deflated_png(parts);
  ASSERT_TRUE(png);
  EXPECT_TRUE(pixels_of(*png) == image.pixels);
}

TEST(DeflatedPng, LeavesOtherImagesToStb) {
  const std::pair<std::string, Bytes> end{"IEND", {}}, data{"IDAT", Bytes(9)};
  EXPECT_TRUE(deflated_png(file_of({{"IHDR", header(1, 1)}, data, end})));
  for (const Bytes& other :
       {header(1, 1, 16), header(1, 1, 8, 2), header(1, 1, 8, 6, 1), header(0, 1), header(1, 0),
        header(65537, 1), header(65536, 65536), Bytes(12), Bytes(14)})
    EXPECT_FALSE(deflated_png(file_of({{"IHDR", other}, data, end})));
  const std::pair<std::string, Bytes> size{"IHDR", header(1, 1)};
  for (const auto& chunks : {std::vector{data, size, end},
                             {size, size, data, end},
                             {size, {"PLTE", Bytes(3)}, data, end},
                             {size, {"tRNS", Bytes(6)}, data, end},
                             {end}})
    EXPECT_FALSE(deflated_png(file_of(chunks)));
  EXPECT_FALSE(deflated_png({}));
  EXPECT_FALSE(deflated_png(Bytes(100)));
}

TEST(DeflatedPng, RejectsDamage) {
  const Bytes file = encode_png(noise(9, 9));
  for (std::size_t length = 0; length < file.size() - 4; ++length)  // the last checksum may lack
    EXPECT_FALSE(deflated_png(std::span(file).first(length))) << length;
  for (std::size_t at = 0; at < file.size() - 12; ++at) {
    Bytes damaged = file;
    damaged[at] ^= std::byte{0x10};
    EXPECT_FALSE(deflated_png(damaged)) << at;
  }
}

}  // namespace deflated_png_test
}  // namespace tureen
