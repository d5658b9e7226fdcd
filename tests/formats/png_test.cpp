// What the PNG encoder writes comes back to the bit, in chunks that other readers accept.
#include "formats/png.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <functional>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace tureen {
namespace {

using Bytes = std::vector<std::byte>;

Image8 picture(int width, int height, const std::function<unsigned(int, int, int)>& value) {
  Image8 image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 4; ++c)
        image.pixels[std::size_t(y) * std::size_t(width) + std::size_t(x)][c] =
            static_cast<std::uint8_t>(value(x, y, c));
  return image;
}

TEST(Png, EveryKindOfPictureComesBack) {
  std::mt19937 random(5);
  for (const auto& [width, height] :
       {std::pair(1, 1), std::pair(1, 9), std::pair(9, 1), std::pair(7, 5), std::pair(130, 67)}) {
    const std::vector<std::pair<const char*, Image8>> pictures = {
        {"noise", picture(width, height, [&](int, int, int) { return unsigned(random()); })},
        {"flat", picture(width, height, [](int, int, int c) { return 50u + unsigned(c); })},
        {"ramp", picture(width, height, [](int x, int y, int c) { return 3 * x + 5 * y + c; })},
        {"columns", picture(width, height, [](int x, int, int) { return x * x * 37u; })},
        {"rows", picture(width, height, [](int, int y, int) { return y * y * 37u; })},
    };
    for (const auto& [name, image] : pictures) {
      const auto back = decode_image(encode_png(image), "test.png");
      ASSERT_EQ(back.width, width);
      ASSERT_EQ(back.height, height);
      EXPECT_TRUE(back.pixels == image.pixels) << name << ' ' << width << " x " << height;
    }
  }
}

/// stb does not check them; other readers do.
TEST(Png, ChunksCarryTheirSums) {
  const Bytes png = encode_png(picture(9, 9, [](int x, int y, int c) { return x * y + c; }));
  const auto big_endian = [&](std::size_t place) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8 | unsigned(png.at(place + i));
    return value;
  };
  std::string types;
  for (std::size_t place = 8; place < png.size();) {
    const std::size_t size = big_endian(place);
    types += std::string(reinterpret_cast<const char*>(&png.at(place + 4)), 4) + ' ';
    EXPECT_EQ(big_endian(place + 8 + size),
              crc32(0, reinterpret_cast<const Bytef*>(&png.at(place + 4)), uInt(size + 4)));
    place += 12 + size;
  }
  EXPECT_EQ(types, "IHDR IDAT IEND ");
}

TEST(Png, SmoothPicturesShrink) {
  // A slope in both directions: whatever filter is chosen leaves next to nothing.
  const Image8 image = picture(256, 256, [](int x, int y, int c) { return x + 2 * y + c; });
  EXPECT_LT(encode_png(image).size(), image.pixels.size() * 4 / 100);
}

}  // namespace
}  // namespace tureen
