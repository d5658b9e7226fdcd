// The PNG encoder preserves images bit by bit, in chunks that other readers accept.
#include "image/png.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <functional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "tests/support/errors.hpp"

namespace tureen {
namespace png_test {

using test::error_of;
using test::ErrorAt;
using test::ErrorIn;
using test::Refusal;
using Bytes = std::vector<std::byte>;

Image8 made_image(int width, int height, const std::function<unsigned(int, int, int)>& value) {
  Image8 image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 4; ++c)
        image.pixels[std::size_t(y) * std::size_t(width) + std::size_t(x)][c] =
            static_cast<std::uint8_t>(value(x, y, c));
  return image;
}

TEST(Png, EveryKindOfImageComesBack) {
  std::mt19937 random(5);
  for (const auto& [width, height] :
       {std::pair(1, 1), std::pair(1, 9), std::pair(9, 1), std::pair(7, 5), std::pair(130, 67)}) {
    const std::vector<std::pair<const char*, Image8>> images = {
        {"noise", made_image(width, height, [&](int, int, int) { return unsigned(random()); })},
        {"flat", made_image(width, height, [](int, int, int c) { return 50u + unsigned(c); })},
        {"ramp", made_image(width, height, [](int x, int y, int c) { return 3 * x + 5 * y + c; })},
        {"columns", made_image(width, height, [](int x, int, int) { return x * x * 37u; })},
        {"rows", made_image(width, height, [](int, int y, int) { return y * y * 37u; })},
    };
    for (const auto& [name, image] : images) {
      const auto back = decode_image(encode_png(image), "test.png");
      ASSERT_EQ(back.width, width);
      ASSERT_EQ(back.height, height);
      EXPECT_TRUE(back.pixels == image.pixels) << name << ' ' << width << " x " << height;
    }
  }
}

std::uint32_t big_endian(const Bytes& bytes, std::size_t place) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8 | unsigned(bytes.at(place + i));
  return value;
}

/// The error from decoding.
std::optional<Refusal> refusal(const Bytes& png) {
  return error_of([&] { decode_image(png, "test.png"); });
}

/// stb does not check the checksums, but other readers do.
TEST(Png, ChunksCarryTheirSums) {
  const Bytes png = encode_png(made_image(9, 9, [](int x, int y, int c) { return x * y + c; }));
  std::string types;
  for (std::size_t place = 8; place < png.size();) {
    const std::size_t size = big_endian(png, place);
    types += std::string(reinterpret_cast<const char*>(&png.at(place + 4)), 4) + ' ';
    EXPECT_EQ(big_endian(png, place + 8 + size),
              crc32(0, reinterpret_cast<const Bytef*>(&png.at(place + 4)), uInt(size + 4)));
    place += 12 + size;
  }
  EXPECT_EQ(types, "IHDR IDAT IEND ");
}

TEST(Png, NoBitOfAnImageIsReadAsAnotherOne) {
  const Bytes png = encode_png(made_image(9, 9, [](int x, int y, int c) { return x * y + c; }));
  ASSERT_EQ(refusal(png), std::nullopt);
  // The last chunk ends the file, with any stated length.
  const std::size_t end = png.size() - 12;
  for (std::size_t place = 0; place < png.size(); ++place)
    for (unsigned bit = 0; bit < 8 && (place < end || place >= end + 4); ++bit) {
      Bytes damaged = png;
      damaged[place] ^= static_cast<std::byte>(1u << bit);
      EXPECT_TRUE(refusal(damaged)) << "bit " << bit << " of byte " << place;
    }
  for (std::size_t size = 8; size + 4 < png.size(); ++size)
    EXPECT_THAT(refusal(Bytes(png.begin(), png.begin() + std::ptrdiff_t(size))),
                ErrorIn("test.png"))
        << size;
  Bytes damaged = png;
  damaged.at(50) ^= std::byte{1};
  EXPECT_THAT(refusal(damaged), ErrorAt("test.png@33"));
}

/// Other readers ignore checksums of chunks that do not belong to the image. Transparency belongs
/// to it.
TEST(Png, OnlyChunksOfTheImageCount) {
  const Bytes png = encode_png(made_image(9, 9, [](int x, int y, int c) { return x * y + c; }));
  const auto with_chunk = [&](const char* type, std::uint32_t sum) {
    Bytes longer = png;
    Bytes chunk(12);  // without content
    for (std::size_t i = 0; i < 4; ++i) {
      chunk[4 + i] = static_cast<std::byte>(type[i]);
      chunk[8 + i] = static_cast<std::byte>(sum >> (24 - 8 * i) & 0xff);
    }
    longer.insert(longer.begin() + 8 + 25, chunk.begin(), chunk.end());  // after the header
    return refusal(longer);
  };
  EXPECT_EQ(with_chunk("tEXt", 0), std::nullopt);
  EXPECT_THAT(with_chunk("PLTE", 0), ErrorAt("test.png@33"));
  EXPECT_THAT(with_chunk("tRNS", 0), ErrorAt("test.png@33"));
}

TEST(Png, SmoothImagesShrink) {
  // A slope in both directions: with any filter, the residual is almost 0.
  const Image8 image = made_image(256, 256, [](int x, int y, int c) { return x + 2 * y + c; });
  EXPECT_LT(encode_png(image).size(), image.pixels.size() * 4 / 100);
}

}  // namespace png_test
}  // namespace tureen
