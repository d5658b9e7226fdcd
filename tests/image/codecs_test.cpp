// WebP images and EXIF orientations.
#include <gtest/gtest.h>
#include <webp/encode.h>

#include <cstring>
#include <random>

#include "base/error.hpp"
#include "image/codecs/exif.hpp"
#include "image/codecs/webp.hpp"
#include "image/png.hpp"

namespace tureen {
namespace codecs_test {

Image8 noise(int width, int height) {
  std::mt19937 random(3);
  Image8 image(width, height);
  for (auto& pixel : image.pixels)
    pixel = glm::u8vec4(random(), random(), random(), 1 + random() % 255);
  return image;
}

std::vector<std::byte> webp_of(const Image8& image) {
  std::uint8_t* bytes = nullptr;
  const std::size_t size =
      WebPEncodeLosslessRGBA(reinterpret_cast<const std::uint8_t*>(image.pixels.data()),
                             image.width, image.height, 4 * image.width, &bytes);
  std::vector<std::byte> result(size);
  std::memcpy(result.data(), bytes, size);
  WebPFree(bytes);
  return result;
}

TEST(WebP, IsReadExactlyAndSurvivesTruncation) {
  const Image8 image = noise(37, 21);
  const std::vector<std::byte> bytes = webp_of(image);
  EXPECT_EQ(decode_image(bytes, "a.webp").pixels, image.pixels);
  for (std::size_t size = 0; size < bytes.size(); size += 7)
    EXPECT_THROW(decode_image(std::span(bytes).first(size), "a.webp"), InputError) << size;
  for (std::size_t i = 0; i < bytes.size(); i += 5) {
    std::vector<std::byte> damaged = bytes;
    damaged[i] ^= std::byte{0x55};
    try {
      decode_image(damaged, "a.webp");
    } catch (const InputError&) {
    }
  }
  EXPECT_THROW(decode_image(bytes, "a.webp", MemoryBudget(1000)), InputError);
}

TEST(DecodeImage, NamesOtherKindsWithTheWayOut) {
  const auto message = [](std::string head) {
    head.resize(64);
    try {
      decode_image(std::as_bytes(std::span(head)), "x/photo.heic");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(message(std::string("\0\0\0\x18"
                                "ftypheic",
                                12))
                .find("HEIC"),
            std::string::npos);
  EXPECT_NE(message(std::string("\0\0\0\x18"
                                "ftypavif",
                                12))
                .find("AVIF"),
            std::string::npos);
  EXPECT_NE(message("II*").find("TIFF"), std::string::npos);
  EXPECT_NE(message("II*").find("x/photo.png"), std::string::npos);
  EXPECT_EQ(message(std::string("\0\0\0\x18"
                                "ftypmp42",
                                12))
                .find("convert"),
            std::string::npos);
}

/// The start of a JPEG with this orientation.
std::vector<std::byte> jpeg_with(int orientation, bool big_endian) {
  std::vector<std::byte> bytes;
  const auto add = [&](std::initializer_list<int> values) {
    for (const int value : values) bytes.push_back(std::byte(value));
  };
  add({0xff, 0xd8, 0xff, 0xe0, 0, 4, 1, 2, 0xff, 0xe1, 0, 34, 'E', 'x', 'i', 'f', 0, 0});
  if (big_endian)
    add({'M', 'M', 0, 42, 0, 0, 0,           8, 0, 1, 1, 18, 0,
         3,   0,   0, 0,  1, 0, orientation, 0, 0, 0, 0, 0,  0});
  else
    add({'I', 'I', 42, 0, 8, 0,           0, 0, 1, 0, 18, 1, 3,
         0,   1,   0,  0, 0, orientation, 0, 0, 0, 0, 0,  0, 0});
  add({0xff, 0xda, 0, 2});
  return bytes;
}

TEST(Exif, TheTopIsWhereTurningTakesItFrom) {
  for (int orientation = 1; orientation <= 8; ++orientation) {
    // The middle of each side has its own value.
    Image8 stored(3, 3);
    const glm::ivec2 top = stored_top(orientation);
    stored.at(1 + top.x, 1 - top.y).r = 200;
    EXPECT_EQ(turned(stored, orientation).at(1, 0).r, 200) << orientation;
  }
}

TEST(Exif, OrientationIsFoundInBothByteOrders) {
  for (const bool big_endian : {false, true}) {
    for (int orientation = 1; orientation <= 8; ++orientation)
      EXPECT_EQ(exif_orientation(jpeg_with(orientation, big_endian)), orientation);
    EXPECT_EQ(exif_orientation(jpeg_with(9, big_endian)), 1);
    const std::vector<std::byte> whole = jpeg_with(6, big_endian);
    for (std::size_t size = 0; size < whole.size(); ++size) {
      const int found = exif_orientation(std::span(whole).first(size));
      EXPECT_TRUE(found == 1 || found == 6);
    }
  }
  EXPECT_EQ(exif_orientation({}), 1);
}

/// A JPEG whose EXIF data have the focal length 5.25 mm, as 21 / 4.
std::vector<std::byte> jpeg_with_focal_length() {
  const int values[] = {0xff, 0xd8, 0xff, 0xe1, 0, 60, 'E', 'x',  'i',  'f',  0, 0,  //
                        'M',  'M',  0,    42,   0, 0,  0,   8,  // the first list is at 8
                        0,    1,    0x87, 0x69, 0, 4,  0,   0,    0,    1,    0, 0, 0,
                        26,   0,    0,    0,    0, 0,  1,   0x92, 0x0a, 0,    5, 0, 0,
                        0,    1,    0,    0,    0, 44, 0,   0,    0,    0,  // the second one at 26
                        0,    0,    0,    21,   0, 0,  0,   4,    0xff, 0xda, 0, 2};
  std::vector<std::byte> bytes;
  for (const int value : values) bytes.push_back(std::byte(value));
  return bytes;
}

TEST(Exif, FocalLengthIsFound) {
  const std::vector<std::byte> whole = jpeg_with_focal_length();
  EXPECT_EQ(exif_focal_length(whole), 5.25);
  for (std::size_t size = 0; size + 4 < whole.size(); ++size)
    EXPECT_FALSE(exif_focal_length(std::span(whole).first(size))) << size;
  EXPECT_FALSE(exif_focal_length(jpeg_with(6, true)));
}

TEST(Exif, TurnsAsTheStandardSays) {
  // 1 2 3
  // 4 5 6
  Image8 image(3, 2);
  for (int i = 0; i < 6; ++i) image.pixels[std::size_t(i)] = glm::u8vec4(i + 1);
  const auto rows = [&](int orientation) {
    const Image8 result = turned(image, orientation);
    std::string text;
    for (int y = 0; y < result.height; ++y, text += '/')
      for (int x = 0; x < result.width; ++x) text += char('0' + result.at(x, y).r);
    return text;
  };
  EXPECT_EQ(rows(1), "123/456/");
  EXPECT_EQ(rows(2), "321/654/");
  EXPECT_EQ(rows(3), "654/321/");
  EXPECT_EQ(rows(4), "456/123/");
  EXPECT_EQ(rows(5), "14/25/36/");
  EXPECT_EQ(rows(6), "41/52/63/");
  EXPECT_EQ(rows(7), "63/52/41/");
  EXPECT_EQ(rows(8), "36/25/14/");
}

}  // namespace codecs_test
}  // namespace tureen
