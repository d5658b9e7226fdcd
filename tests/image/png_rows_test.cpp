// Writing row by row preserves images.
#include "image/png_rows.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <random>

#include "image/png.hpp"

namespace tureen {
namespace png_rows_test {

namespace fs = std::filesystem;

/// Noise, which no filter improves, and ramps, each of which suits one filter.
Image8 made_image(int width, int height, unsigned seed) {
  std::mt19937 random(seed);
  Image8 image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto noise = std::uint8_t(random());
      const bool busy = y % 8 < 2;
      image.at(x, y) = glm::u8vec4(busy ? noise : x, busy ? noise / 2 : y, x + y, 255 - x / 3);
    }
  return image;
}

Image8 written_and_read(const Image8& image, int band, const fs::path& path) {
  Output output(path);
  PngRows rows(output, image.width, image.height);
  for (int y = 0; y < image.height; y += band) {
    Image8 part(image.width, std::min(band, image.height - y));
    std::copy_n(&image.at(0, y), part.pixels.size(), part.pixels.begin());
    rows.append(part);
  }
  rows.finish();
  output.commit();
  Input input = Input::open(path);
  return read_image(input);
}

TEST(PngRows, ComeBackHoweverTheyAreCut) {
  const fs::path path = fs::path(testing::TempDir()) / "tureen_png_rows.png";
  for (const auto& [width, height] : {std::pair(1, 1), {1, 50}, {50, 1}, {300, 211}})
    for (const int band : {1, 7, 64, 1000}) {
      const Image8 image = made_image(width, height, 1);
      const Image8 back = written_and_read(image, band, path);
      ASSERT_EQ(back.width, width);
      ASSERT_EQ(back.height, height);
      EXPECT_EQ(back.pixels, image.pixels) << width << " x " << height << " by " << band;
    }
  fs::remove(path);
}

/// Several chunks: the state between rows must not be lost or doubled.
TEST(PngRows, ManyChunksComeBack) {
  const fs::path path = fs::path(testing::TempDir()) / "tureen_png_chunks.png";
  std::mt19937 random(2);
  Image8 image(700, 500);
  for (glm::u8vec4& pixel : image.pixels)
    pixel = glm::u8vec4(random(), random(), random(), random());
  EXPECT_EQ(written_and_read(image, 33, path).pixels, image.pixels);
  EXPECT_GT(fs::file_size(path), image.pixels.size() * 4);  // noise: five chunks
  fs::remove(path);
}

/// The reader takes the high byte of 16 bits; the low one must not disturb it.
TEST(PngRows, SixteenBitsAreBigEndian) {
  const fs::path path = fs::path(testing::TempDir()) / "tureen_png_16.png";
  for (const PngPixels pixels : {PngPixels::grey16, PngPixels::rgb16}) {
    const int channels = pixels == PngPixels::rgb16 ? 3 : 1;
    std::mt19937 random(4);
    std::vector<std::uint16_t> values(std::size_t(40 * 30 * channels));
    for (std::uint16_t& value : values) value = std::uint16_t(random());
    Output output(path);
    PngRows rows(output, 40, 30, pixels);
    rows.append(std::span(values).first(std::size_t(40 * 7 * channels)));
    rows.append(std::span(values).subspan(std::size_t(40 * 7 * channels)));
    rows.finish();
    output.commit();
    Input input = Input::open(path);
    const Image8 back = read_image(input);
    ASSERT_EQ(back.pixels.size(), 1200u);
    for (std::size_t i = 0; i < back.pixels.size(); ++i)
      for (int c = 0; c < 3; ++c)
        ASSERT_EQ(back.pixels[i][c],
                  values[std::size_t(channels) * i + std::size_t(std::min(c, channels - 1))] >> 8);
  }
  fs::remove(path);
}

/// The file is as small as from the encoder of whole images, except for the chunks' frames.
TEST(PngRows, AreAsSmallAsWholeImages) {
  const fs::path path = fs::path(testing::TempDir()) / "tureen_png_size.png";
  const Image8 image = made_image(400, 300, 3);
  written_and_read(image, 50, path);
  EXPECT_LE(double(fs::file_size(path)), 1.05 * double(encode_png(image).size()));
  fs::remove(path);
}

}  // namespace png_rows_test
}  // namespace tureen
