// What the PNG encoder writes comes back to the bit through decoders that are not ours: stb_image
// for the picture, zlib for the compressed bytes.
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

#include "formats/deflate.hpp"

namespace tureen {
namespace {

using Bytes = std::vector<std::byte>;

Bytes made(std::size_t size, const std::function<unsigned(std::size_t)>& value) {
  Bytes bytes(size);
  for (std::size_t i = 0; i < size; ++i) bytes[i] = std::byte(value(i) & 255u);
  return bytes;
}

/// zlib checks the header, every code and the sum; nothing may follow.
void expect_inflates(const Bytes& bytes, const std::string& what) {
  const Bytes packed = zlib_compress(bytes);
  EXPECT_LE(packed.size(), bytes.size() + bytes.size() / 1000 + 20) << what;
  Bytes back(bytes.size() + 1);
  auto size = static_cast<uLongf>(back.size());
  auto used = static_cast<uLong>(packed.size());
  ASSERT_EQ(uncompress2(reinterpret_cast<Bytef*>(back.data()), &size,
                        reinterpret_cast<const Bytef*>(packed.data()), &used),
            Z_OK)
      << what;
  EXPECT_EQ(used, packed.size()) << what;
  back.resize(size);
  EXPECT_TRUE(back == bytes) << what;
}

TEST(Deflate, EveryShortLength) {
  std::mt19937 random(1);
  for (std::size_t size = 0; size <= 300; ++size) {
    const std::string what = std::to_string(size) + " bytes";
    expect_inflates(made(size, [](std::size_t) { return 7u; }), what + ", one value");
    expect_inflates(made(size, [&](std::size_t) { return unsigned(random()); }), what + ", noise");
    expect_inflates(made(size, [&](std::size_t) { return unsigned(random() % 3); }),
                    what + ", three values");
  }
}

TEST(Deflate, ManyBlocks) {
  std::mt19937 random(2);
  // Prime sizes: no block ends where the data does.
  expect_inflates(made(200'003, [&](std::size_t) { return unsigned(random()); }), "noise");
  expect_inflates(made(2'000'003, [](std::size_t) { return 0u; }), "zeros");
  std::geometric_distribution<unsigned> skewed(0.3);
  expect_inflates(made(300'007, [&](std::size_t) { return skewed(random); }), "skewed noise");
  // Noise that gives way to zeros: stored blocks beside coded ones.
  expect_inflates(
      made(300'007, [&](std::size_t i) { return i / 50'000 % 2 ? 0u : unsigned(random()); }),
      "noise and zeros");
}

TEST(Deflate, RepeatsAtEveryDistanceOfTheWindowAndBeyond) {
  std::mt19937 random(3);
  for (const std::size_t period : {1u, 2u, 3u, 4u, 5u, 8u, 257u, 258u, 259u, 2047u, 2048u, 2049u,
                                   24577u, 32767u, 32768u, 32769u, 65536u}) {
    const Bytes once = made(period, [&](std::size_t) { return unsigned(random()); });
    const Bytes all =
        made(3 * period + 11, [&](std::size_t i) { return unsigned(once[i % period]); });
    expect_inflates(all, "period " + std::to_string(period));
    // 32768 is the furthest that DEFLATE reaches; each repeat of 258 bytes takes some 5 bytes.
    if (period >= 2047 && period <= 32768) {
      EXPECT_LT(zlib_compress(all).size(), 1.1 * period + 200);
    }
  }
}

TEST(Deflate, CountsThatWouldMakeCodesTooLongAreFlattened) {
  // Fibonacci counts give the deepest Huffman tree there is: 17 values, 16 levels; 15 are allowed.
  // The noise between them keeps the frequent ones from being told as repeats. It hangs on the luck
  // of the seed whether the tree is too deep: without the limit some of these 16 fail.
  for (unsigned seed = 0; seed < 16; ++seed) {
    std::mt19937 random(seed);
    std::vector<unsigned> values;
    for (unsigned value = 0, count = 1, next = 1; value < 17; ++value) {
      values.insert(values.end(), count, value);
      count = std::exchange(next, count + next);
    }
    std::shuffle(values.begin(), values.end(), random);
    Bytes bytes;
    for (const unsigned value : values) {
      bytes.push_back(std::byte(value));
      if (bytes.size() % 4 == 3) bytes.push_back(std::byte(30 + random() % 200));
    }
    expect_inflates(bytes, "seed " + std::to_string(seed));
  }
}

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
