// The decoder of lossless WebP against libwebp: on what its encoder writes, and on random streams
// with every transform, predictor mode, code and kind of copy, which no encoder writes together.
#include "image/codecs/vp8l.hpp"

#include <gtest/gtest.h>
#include <webp/decode.h>
#include <webp/encode.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <random>

#include "base/error.hpp"
#include "tests/formats/truncation.hpp"

namespace tureen {
namespace vp8l_test {

using Bytes = std::vector<std::byte>;

std::optional<Image8> by_libwebp(const Bytes& file) {
  int width = 0, height = 0;
  std::uint8_t* rgba = WebPDecodeRGBA(reinterpret_cast<const std::uint8_t*>(file.data()),
                                      file.size(), &width, &height);
  if (!rgba) return std::nullopt;
  Image8 image(width, height);
  std::memcpy(image.pixels.data(), rgba, image.pixels.size() * 4);
  WebPFree(rgba);
  return image;
}

Image8 by_us(const Bytes& file) {
  const auto stream = vp8l_stream(file, "a.webp");
  if (!stream) throw InputError({"a.webp"}, "no lossless image");
  return decode_vp8l(*stream, "a.webp", MemoryBudget());
}

/// The file of a stream.
Bytes riff(const std::string& stream) {
  std::string file = "RIFF....WEBPVP8L....";
  const auto put = [&](std::size_t at, std::size_t value) {
    for (std::size_t i = 0; i < 4; ++i) file[at + i] = char(value >> (8 * i));
  };
  const std::size_t padded = stream.size() + stream.size() % 2;
  put(4, 12 + padded);
  put(16, stream.size());
  file += stream;
  file.resize(20 + padded);
  const auto bytes = std::as_bytes(std::span(file));
  return {bytes.begin(), bytes.end()};
}

Bytes encoded(const Image8& image, float quality, int method) {
  WebPConfig config;
  WebPConfigInit(&config);
  config.lossless = 1;
  config.exact = 1;
  config.quality = quality;
  config.method = method;
  WebPPicture picture;
  WebPPictureInit(&picture);
  picture.use_argb = 1;
  picture.width = image.width;
  picture.height = image.height;
  WebPPictureImportRGBA(&picture, reinterpret_cast<const std::uint8_t*>(image.pixels.data()),
                        4 * image.width);
  WebPMemoryWriter writer;
  WebPMemoryWriterInit(&writer);
  picture.writer = WebPMemoryWrite;
  picture.custom_ptr = &writer;
  EXPECT_TRUE(WebPEncode(&config, &picture));
  Bytes result(writer.size);
  std::memcpy(result.data(), writer.mem, writer.size);
  WebPMemoryWriterClear(&writer);
  WebPPictureFree(&picture);
  return result;
}

/// Images that differ in what compresses them: few colours, gradients, noise, and parts of each.
Image8 test_image(int kind, int width, int height) {
  std::mt19937 random(static_cast<unsigned>(kind));
  Image8 image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const int part = kind < 9 ? kind : (x / 40 + y / 40) % 9;
      const unsigned colors = part < 5 ? 1u << (2 * part) : 0;  // 1, 4, 16, 64, 256
      const unsigned pick = colors ? unsigned(random() % colors) * 2654435761u : 0;
      glm::u8vec4& pixel = image.at(x, y);
      if (colors)
        pixel = {pick, pick >> 8, pick >> 16, pick >> 24};
      else if (part < 7)
        pixel = {x + y, x * 2 - y, (x * y) >> 4, part == 5 ? 255 : y};
      else
        pixel = {random(), x, random() % 8, 252 + random() % 4};
    }
  return image;
}

TEST(Vp8l, ImagesByLibwebpHaveTheSamePixels) {
  for (int kind = 0; kind < 11; ++kind)
    for (const auto& [width, height] : {std::pair(1, 1), {7, 150}, {201, 5}, {150, 110}})
      for (const float quality : {0.0f, 75.0f})
        for (const int method : {0, 4, 6}) {
          const Image8 image = test_image(kind, width, height);
          const Bytes file = encoded(image, quality, method);
          const Image8 found = by_us(file);
          ASSERT_EQ(found.width, width);
          ASSERT_TRUE(found.pixels == image.pixels)
              << "kind " << kind << ", " << width << " x " << height << ", quality " << quality
              << ", method " << method;
        }
}

/// A stream of random content.
class RandomStream {
 public:
  explicit RandomStream(unsigned seed) : random_(seed) {}

  std::string make() {
    int width = below(90) + 1;
    const int height = below(40) + 1;
    bits(0x2f, 8);
    bits(std::uint32_t(width - 1), 14);
    bits(std::uint32_t(height - 1), 14);
    bits(std::uint32_t(below(2)), 1);
    bits(0, 3);
    std::vector<int> kinds{0, 1, 2, 3};
    std::shuffle(kinds.begin(), kinds.end(), random_);
    kinds.resize(std::size_t(below(5)));
    for (const int kind : kinds) {
      bits(1, 1);
      bits(std::uint32_t(kind), 2);
      if (kind < 2) {
        const int size = below(3);
        bits(std::uint32_t(size), 3);
        image(blocks(width, size + 2), blocks(height, size + 2));
      } else if (kind == 3) {
        const int colors = 1 + below(below(2) ? 256 : 20);
        bits(std::uint32_t(colors - 1), 8);
        image(colors, 1);
        width = blocks(width, colors > 16 ? 0 : colors > 4 ? 1 : colors > 2 ? 2 : 3);
      }
    }
    bits(0, 1);
    main_image(width, height);
    while (used_ % 8) bits(0, 1);
    return bytes_;
  }

 private:
  int below(int n) { return int(random_() % unsigned(n)); }
  static int blocks(int size, int bits) { return (size + (1 << bits) - 1) >> bits; }

  void bits(std::uint32_t value, int count) {
    for (int i = 0; i < count; ++i, ++used_) {
      if (used_ % 8 == 0) bytes_ += '\0';
      bytes_.back() = char(std::uint8_t(bytes_.back()) | (value >> i & 1) << (used_ % 8));
    }
  }

  /// A complete code of n symbols with lengths that differ by at most 1, or, with `skew`, of the
  /// lengths 1, 2, 3, .. 10 and then equal ones. Writes it and remembers it.
  struct Code {
    std::vector<int> lengths;
    std::vector<std::uint32_t> codes;
  };
  Code code(int n) {
    Code made;
    made.lengths.assign(std::size_t(n), 0);
    const int skew = n > 40 && below(2) ? 1 + below(3) : 0;
    for (int i = 0; i < skew; ++i) made.lengths[std::size_t(n - 1 - i)] = i + 1;
    const int rest = n - skew;
    const int longest = int(std::bit_width(unsigned(rest - 1)));
    const int shorter = (1 << longest) - rest;
    for (int i = 0; i < rest; ++i)
      made.lengths[std::size_t(i)] = skew + longest - (i < shorter ? 1 : 0);
    std::vector<std::uint32_t> next(18, 0), counts(18, 0);
    for (const int l : made.lengths) ++counts[std::size_t(l)];
    for (std::size_t l = 1; l < 16; ++l) next[l + 1] = (next[l] + counts[l]) << 1;
    for (const int l : made.lengths) made.codes.push_back(next[std::size_t(l)]++);
    // 16 code lengths of 4 bits for the lengths 0 to 15 themselves.
    constexpr int order[19] = {17, 18, 0, 1, 2, 3, 4, 5, 16, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    bits(0, 1);
    bits(15, 4);
    for (const int symbol : order) bits(symbol < 16 ? 4 : 0, 3);
    bits(0, 1);
    for (const int l : made.lengths) reversed(std::uint32_t(l), 4);
    return made;
  }
  void reversed(std::uint32_t value, int count) {
    for (int i = count; i-- > 0;) bits(value >> i & 1, 1);
  }
  void put(const Code& code, int symbol) {
    reversed(code.codes[std::size_t(symbol)], code.lengths[std::size_t(symbol)]);
  }
  /// A value from 1 on by its prefix symbol, which is `first` + 0 .. 39, and further bits.
  void prefixed(const Code& code, int first, std::uint32_t value) {
    if (value <= 4) return put(code, first + int(value) - 1);
    const std::uint32_t rest = value - 1;
    const int high = int(std::bit_width(rest)) - 1;
    put(code, first + 2 * high + int(rest >> (high - 1) & 1));
    bits(rest & ((1u << (high - 1)) - 1), high - 1);
  }

  void image(int width, int height) {
    const int cache = below(2) ? 0 : 1 + below(11);
    bits(cache > 0, 1);
    if (cache > 0) bits(std::uint32_t(cache), 4);
    pixels(width, height, cache, 0, {});
  }
  void main_image(int width, int height) {
    const int cache = below(2) ? 0 : 1 + below(11);
    bits(cache > 0, 1);
    if (cache > 0) bits(std::uint32_t(cache), 4);
    const bool has_regions = below(2);
    bits(has_regions, 1);
    if (!has_regions) return pixels(width, height, cache, 0, {});
    // Every literal of this image is 0 or 1 in green: two groups.
    const int size = below(2);
    bits(std::uint32_t(size), 3);
    std::vector<int> regions;
    bits(0, 1);
    bits(1, 1);  // green: two symbols
    bits(1, 1);
    bits(0, 1);
    bits(0, 1);
    bits(1, 8);
    for (int i = 0; i < 4; ++i) bits(0b0001, 4);  // others: only 0
    for (int i = 0; i < blocks(width, size + 2) * blocks(height, size + 2); ++i) {
      regions.push_back(below(2));
      bits(std::uint32_t(regions.back()), 1);
    }
    // Both groups must exist.
    if (std::count(regions.begin(), regions.end(), 1) == 0)
      return pixels(width, height, cache, 0, {});
    pixels(width, height, cache, size + 2, regions);
  }

  void pixels(int width, int height, int cache, int region_bits, const std::vector<int>& regions) {
    std::vector<std::array<Code, 5>> groups(regions.empty() ? 1 : 2);
    for (auto& group : groups) {
      group[0] = code(256 + 24 + (cache ? 1 << cache : 0));
      for (std::size_t i = 1; i < 4; ++i) group[i] = code(256);
      group[4] = code(40);
    }
    const int count = width * height;
    for (int at = 0; at < count;) {
      const int x = at % width, y = at / width;
      const auto& group =
          regions.empty()
              ? groups[0]
              : groups[std::size_t(regions[std::size_t(
                    (y >> region_bits) * blocks(width, region_bits) + (x >> region_bits))])];
      const int choice = below(10);
      if (choice < 2 && at > 0) {
        const int length = 1 + below(std::min(count - at, below(4) ? 9 : 200));
        prefixed(group[0], 256, std::uint32_t(length));
        // Codes up to 120 reach at most 8 pixels aside and 7 rows up.
        if (at >= 7 * width + 8 && below(2))
          prefixed(group[4], 0, std::uint32_t(1 + below(120)));
        else
          prefixed(group[4], 0, std::uint32_t(120 + 1 + below(at)));
        at += length;
        continue;
      }
      if (choice < 4 && cache > 0) {
        put(group[0], 280 + below(1 << cache));
      } else {
        for (std::size_t i = 0; i < 4; ++i) put(group[i], below(256));
      }
      ++at;
    }
  }

  std::mt19937 random_;
  std::string bytes_;
  std::size_t used_ = 0;
};

TEST(Vp8l, RandomStreamsHaveThePixelsOfLibwebp) {
  int read = 0;
  for (unsigned seed = 0; seed < 600; ++seed) {
    const Bytes file = riff(RandomStream(seed).make());
    const std::optional<Image8> expected = by_libwebp(file);
    ASSERT_TRUE(expected) << "seed " << seed;
    ASSERT_TRUE(by_us(file).pixels == expected->pixels) << "seed " << seed;
    ++read;
  }
  EXPECT_EQ(read, 600);
}

TEST(Vp8l, DamageIsReadAsByLibwebpOrRefused) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    const Bytes file = riff(RandomStream(seed).make());
    const auto read = [](std::span<const std::byte> bytes) { by_us({bytes.begin(), bytes.end()}); };
    const test::Survival cut = test::survive_truncation(file, read);
    EXPECT_EQ(cut.read, 0u);
    test::survive_damage(file, read, test::Damage::one);
    // Where both read the damaged file, they read the same.
    std::mt19937 random(seed);
    for (int i = 0; i < 300; ++i) {
      Bytes damaged = file;
      damaged[20 + random() % (file.size() - 20)] ^= std::byte(1u << random() % 8);
      std::optional<Image8> ours;
      try {
        ours = by_us(damaged);
      } catch (const InputError&) {
      }
      const std::optional<Image8> theirs = by_libwebp(damaged);
      if (ours && theirs) {
        EXPECT_TRUE(ours->pixels == theirs->pixels) << seed << " " << i;
      }
    }
  }
}

TEST(Vp8l, ASmallFileOfAHugeImageIsRefusedBeforeItIsMade) {
  // 16,384 x 16,384 pixels, all codes of one symbol: no bits per pixel.
  std::string stream("\x2f\xff\xff\xff\x0f", 5);
  stream += std::string(4, '\x22');
  EXPECT_THROW(decode_vp8l(std::as_bytes(std::span(stream)), "a.webp", MemoryBudget(100 << 20)),
               InputError);
}

}  // namespace vp8l_test
}  // namespace tureen
