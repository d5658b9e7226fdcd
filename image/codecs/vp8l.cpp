#include "image/codecs/vp8l.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/little_endian.hpp"

namespace tureen {

namespace vp8l {
namespace {

/// A pixel as 0xAARRGGBB.
using Argb = std::uint32_t;
constexpr Argb opaque_black = 0xff000000u;

constexpr int literals = 256, length_symbols = 24, distance_symbols = 40;
constexpr int max_code_length = 15;
constexpr int max_cache_bits = 11;

Argb channel(Argb pixel, int shift) { return pixel >> shift & 0xff; }

/// Sum by channel, modulo 256. Even and odd channels are added apart, so that no carry passes on.
Argb added(Argb a, Argb b) {
  return (((a & 0xff00ff00u) + (b & 0xff00ff00u)) & 0xff00ff00u) |
         (((a & 0x00ff00ffu) + (b & 0x00ff00ffu)) & 0x00ff00ffu);
}

/// Floor of the mean by channel.
Argb mean(Argb a, Argb b) { return (a & b) + (((a ^ b) & 0xfefefefeu) >> 1); }

/// Bits from the lowest of each byte on.
class Bits {
 public:
  explicit Bits(std::span<const std::byte> bytes) : bytes_(bytes) {}

  /// At least 32 valid bits, zeros beyond the end.
  std::uint32_t peek() {
    while (count_ < 32) {
      if (at_ < bytes_.size()) held_ |= std::to_integer<std::uint64_t>(bytes_[at_]) << count_;
      ++at_;
      count_ += 8;
    }
    return static_cast<std::uint32_t>(held_);
  }
  void skip(int bits) {
    held_ >>= bits;
    count_ -= bits;
  }
  /// bits <= 24
  std::uint32_t read(int bits) {
    const std::uint32_t value = peek() & ((std::uint32_t(1) << bits) - 1);
    skip(bits);
    return value;
  }
  /// Whether bits beyond the end were consumed.
  bool is_past_end() const { return at_ > bytes_.size() + std::size_t(count_) / 8; }

 private:
  std::span<const std::byte> bytes_;
  std::size_t at_ = 0;
  std::uint64_t held_ = 0;
  int count_ = 0;
};

/// A prefix code: a table of the first bits, and for longer codes the canonical order.
struct PrefixCode {
  static constexpr int table_bits = 9;
  struct Entry {
    std::uint16_t symbol = 0;
    std::uint8_t length = 0;  // in bits; above `bits` the code is longer than the table's index
  };
  int bits = 0;  // of the table's index; 0 with one symbol, which then takes no bits
  std::vector<Entry> table;
  std::vector<std::uint16_t> symbols;  // by length, then by value; empty if the table has all
  std::array<std::uint16_t, max_code_length + 1> counts{};

  int read(Bits& in) const {
    const std::uint32_t next = in.peek();
    const Entry entry = table[next & ((1u << bits) - 1)];
    if (entry.length <= bits) {
      in.skip(entry.length);
      return entry.symbol;
    }
    // Canonical codes of one length are consecutive numbers, first bit highest.
    std::uint32_t code = 0, first = 0, index = 0;
    for (int length = 1; length <= max_code_length; ++length) {
      code = code << 1 | (next >> (length - 1) & 1);
      const std::uint32_t count = counts[std::size_t(length)];
      if (code - first < count) {
        in.skip(length);
        return symbols[index + (code - first)];
      }
      index += count;
      first = (first + count) << 1;
    }
    return entry.symbol;  // not reached: the code is complete
  }
};

/// The five codes of a region of an image: green with lengths and cache, red, blue, alpha,
/// distance.
using CodeGroup = std::array<PrefixCode, 5>;

enum class Transform { predictor, cross_color, subtract_green, color_indexing };

struct AppliedTransform {
  Transform kind = Transform::predictor;
  int block_bits = 0;           // log2 of the side of a block; of indices log2 of pixels a byte
  int width = 0;                // of the image after the inverse
  std::vector<Argb> data = {};  // a value per block, or the palette
};

/// (x, y) of distance codes 1 to 120: pixels above and to the left, by their distance.
constexpr std::array<std::array<std::int8_t, 2>, 120> near_pixels{
    {{0, 1},  {1, 0},  {1, 1},  {-1, 1}, {0, 2},  {2, 0},  {1, 2},  {-1, 2}, {2, 1},  {-2, 1},
     {2, 2},  {-2, 2}, {0, 3},  {3, 0},  {1, 3},  {-1, 3}, {3, 1},  {-3, 1}, {2, 3},  {-2, 3},
     {3, 2},  {-3, 2}, {0, 4},  {4, 0},  {1, 4},  {-1, 4}, {4, 1},  {-4, 1}, {3, 3},  {-3, 3},
     {2, 4},  {-2, 4}, {4, 2},  {-4, 2}, {0, 5},  {3, 4},  {-3, 4}, {4, 3},  {-4, 3}, {5, 0},
     {1, 5},  {-1, 5}, {5, 1},  {-5, 1}, {2, 5},  {-2, 5}, {5, 2},  {-5, 2}, {4, 4},  {-4, 4},
     {3, 5},  {-3, 5}, {5, 3},  {-5, 3}, {0, 6},  {6, 0},  {1, 6},  {-1, 6}, {6, 1},  {-6, 1},
     {2, 6},  {-2, 6}, {6, 2},  {-6, 2}, {4, 5},  {-4, 5}, {5, 4},  {-5, 4}, {3, 6},  {-3, 6},
     {6, 3},  {-6, 3}, {0, 7},  {7, 0},  {1, 7},  {-1, 7}, {5, 5},  {-5, 5}, {7, 1},  {-7, 1},
     {4, 6},  {-4, 6}, {6, 4},  {-6, 4}, {2, 7},  {-2, 7}, {7, 2},  {-7, 2}, {3, 7},  {-3, 7},
     {7, 3},  {-7, 3}, {5, 6},  {-5, 6}, {6, 5},  {-6, 5}, {8, 0},  {4, 7},  {-4, 7}, {7, 4},
     {-7, 4}, {8, 1},  {8, 2},  {6, 6},  {-6, 6}, {8, 3},  {5, 7},  {-5, 7}, {7, 5},  {-7, 5},
     {8, 4},  {6, 7},  {-6, 7}, {7, 6},  {-7, 6}, {8, 5},  {7, 7},  {-7, 7}, {8, 6},  {8, 7}}};

int blocks(int size, int bits) { return (size + (1 << bits) - 1) >> bits; }

Argb selected(Argb left, Argb top, Argb top_left) {
  int to_left = 0, to_top = 0;
  for (const int shift : {0, 8, 16, 24}) {
    const int corner = int(channel(top_left, shift));
    to_left += std::abs(int(channel(top, shift)) - corner);
    to_top += std::abs(int(channel(left, shift)) - corner);
  }
  return to_left < to_top ? left : top;
}

/// clamp(f(a, b, c)) by channel.
template <class Function>
Argb clamped(Argb a, Argb b, Argb c, Function&& f) {
  Argb result = 0;
  for (const int shift : {0, 8, 16, 24})
    result |=
        Argb(std::clamp(f(int(channel(a, shift)), int(channel(b, shift)), int(channel(c, shift))),
                        0, 255))
        << shift;
  return result;
}

/// The prediction from the neighbours left, top, top right and top left.
Argb predicted(int mode, Argb left, Argb top, Argb right, Argb corner) {
  switch (mode) {
    case 1:
      return left;
    case 2:
      return top;
    case 3:
      return right;
    case 4:
      return corner;
    case 5:
      return mean(mean(left, right), top);
    case 6:
      return mean(left, corner);
    case 7:
      return mean(left, top);
    case 8:
      return mean(corner, top);
    case 9:
      return mean(top, right);
    case 10:
      return mean(mean(left, corner), mean(top, right));
    case 11:
      return selected(left, top, corner);
    case 12:
      return clamped(left, top, corner, [](int l, int t, int c) { return l + t - c; });
    case 13:
      return clamped(mean(left, top), corner, 0, [](int m, int c, int) { return m + (m - c) / 2; });
    default:
      return opaque_black;
  }
}

void undo_predictor(const AppliedTransform& transform, std::span<Argb> pixels, int height) {
  const int width = transform.width, columns = blocks(width, transform.block_bits);
  for (int y = 0; y < height; ++y) {
    Argb* row = pixels.data() + std::size_t(y) * std::size_t(width);
    const Argb* above = row - width;  // not read in row 0
    const Argb* modes =
        transform.data.data() + std::size_t(y >> transform.block_bits) * std::size_t(columns);
    row[0] = added(row[0], y == 0 ? opaque_black : above[0]);
    if (y == 0) {
      for (int x = 1; x < width; ++x) row[x] = added(row[x], row[x - 1]);
      continue;
    }
    for (int x = 1; x < width; ++x) {
      const int mode = int(modes[x >> transform.block_bits] >> 8 & 15);
      // Right of the last pixel of the row above follows the first one of this row.
      row[x] = added(row[x], predicted(mode, row[x - 1], above[x], above[x + 1], above[x - 1]));
    }
  }
}

/// 3.5 fixed-point multiple of a signed byte.
int color_delta(Argb factor, Argb value) {
  return int(static_cast<std::int8_t>(factor)) * int(static_cast<std::int8_t>(value)) >> 5;
}

void undo_cross_color(const AppliedTransform& transform, std::span<Argb> pixels, int height) {
  const int width = transform.width, columns = blocks(width, transform.block_bits);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const Argb element =
          transform.data[std::size_t(y >> transform.block_bits) * std::size_t(columns) +
                         std::size_t(x >> transform.block_bits)];
      Argb& pixel = pixels[std::size_t(y) * std::size_t(width) + std::size_t(x)];
      const Argb green = channel(pixel, 8);
      const Argb red = (channel(pixel, 16) + Argb(color_delta(channel(element, 0), green))) & 0xff;
      const Argb blue = (channel(pixel, 0) + Argb(color_delta(channel(element, 8), green)) +
                         Argb(color_delta(channel(element, 16), red))) &
                        0xff;
      pixel = (pixel & 0xff00ff00u) | red << 16 | blue;
    }
}

void undo_subtract_green(std::span<Argb> pixels) {
  for (Argb& pixel : pixels) {
    const Argb green = channel(pixel, 8);
    pixel = added(pixel, green << 16 | green);
  }
}

class Decoder {
 public:
  Decoder(std::span<const std::byte> stream, const std::string& name, MemoryBudget budget)
      : in_(stream), name_(name), budget_(std::move(budget)) {}

  Image8 decode() {
    PassingMemory passing(budget_);
    if (in_.read(8) != 0x2f) fail("its signature is not that of VP8L");
    const int width = int(in_.read(14)) + 1, height = int(in_.read(14)) + 1;
    in_.read(1);  // whether alpha is used: a hint
    if (in_.read(3) != 0) fail("its version is not 0");
    require_bits();
    const std::uint64_t size = std::uint64_t(width) * std::uint64_t(height) * sizeof(Argb);
    // The pixels as they are decoded, and the result.
    take(2 * size, "an image of " + std::to_string(width) + " x " + std::to_string(height));
    std::vector<AppliedTransform> transforms;
    const int packed_width = read_transforms(transforms, width, height);
    std::vector<Argb> pixels = read_pixels(packed_width, height, true);
    for (std::size_t i = transforms.size(); i-- > 0;) undo(transforms[i], pixels, height);
    Image8 image(width, height);
    for (std::size_t i = 0; i < pixels.size(); ++i)
      image.pixels[i] = glm::u8vec4(channel(pixels[i], 16), channel(pixels[i], 8),
                                    channel(pixels[i], 0), channel(pixels[i], 24));
    passing.keep(size);
    return image;
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const {
    throw InputError({name_}, "the WebP image is damaged: " + reason);
  }
  void require_bits() const {
    if (in_.is_past_end()) fail("it ends early");
  }
  void take(std::uint64_t bytes, const std::string& what) {
    if (!budget_.take(bytes)) throw InputError({name_}, budget_.refusal(what), max_memory_hint);
  }

  /// Returns the width of the stored pixels.
  int read_transforms(std::vector<AppliedTransform>& transforms, int width, int height) {
    unsigned seen = 0;
    while (in_.read(1)) {
      AppliedTransform transform{.kind = Transform(in_.read(2)), .width = width};
      const unsigned bit = 1u << int(transform.kind);
      if (seen & bit) fail("a transform occurs twice");
      seen |= bit;
      if (transform.kind == Transform::predictor || transform.kind == Transform::cross_color) {
        transform.block_bits = int(in_.read(3)) + 2;
        transform.data = read_pixels(blocks(width, transform.block_bits),
                                     blocks(height, transform.block_bits), false);
      } else if (transform.kind == Transform::color_indexing) {
        const int colors = int(in_.read(8)) + 1;
        transform.block_bits = colors > 16 ? 0 : colors > 4 ? 1 : colors > 2 ? 2 : 3;
        transform.data = read_pixels(colors, 1, false);
        for (std::size_t i = 1; i < transform.data.size(); ++i)
          transform.data[i] = added(transform.data[i], transform.data[i - 1]);
        transform.data.resize(256);  // transparent black beyond
        width = blocks(width, transform.block_bits);
      }
      transforms.push_back(std::move(transform));
    }
    return width;
  }

  void undo(const AppliedTransform& transform, std::vector<Argb>& pixels, int height) {
    switch (transform.kind) {
      case Transform::predictor:
        return undo_predictor(transform, pixels, height);
      case Transform::cross_color:
        return undo_cross_color(transform, pixels, height);
      case Transform::subtract_green:
        return undo_subtract_green(pixels);
      case Transform::color_indexing:
        return undo_color_indexing(transform, pixels, height);
    }
  }

  void undo_color_indexing(const AppliedTransform& transform, std::vector<Argb>& pixels,
                           int height) {
    const int width = transform.width, columns = blocks(width, transform.block_bits);
    const int bits = 8 >> transform.block_bits;
    take(std::uint64_t(width) * std::uint64_t(height) * sizeof(Argb), "an image with a palette");
    std::vector<Argb> unpacked(std::size_t(width) * std::size_t(height));
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const Argb packed =
            pixels[std::size_t(y) * std::size_t(columns) + std::size_t(x >> transform.block_bits)];
        const int place = x & ((1 << transform.block_bits) - 1);
        const Argb index = channel(packed, 8) >> (place * bits) & ((1u << bits) - 1);
        unpacked[std::size_t(y) * std::size_t(width) + std::size_t(x)] = transform.data[index];
      }
    pixels = std::move(unpacked);
  }

  /// An entropy-coded image. Only the main one has regions with codes of their own.
  std::vector<Argb> read_pixels(int width, int height, bool is_main) {
    int cache_bits = 0;
    if (in_.read(1)) {
      cache_bits = int(in_.read(4));
      if (cache_bits < 1 || cache_bits > max_cache_bits) fail("its colour cache has a wrong size");
    }
    int region_bits = 0;
    std::vector<Argb> regions;
    std::size_t groups = 1;
    if (is_main && in_.read(1)) {
      region_bits = int(in_.read(3)) + 2;
      regions = read_pixels(blocks(width, region_bits), blocks(height, region_bits), false);
      for (Argb& region : regions) {
        region = region >> 8 & 0xffff;
        groups = std::max(groups, std::size_t(region) + 1);
      }
    }
    take(groups * sizeof(CodeGroup), "the codes of an image");
    std::vector<CodeGroup> codes(groups);
    for (CodeGroup& group : codes) {
      const int cache_size = cache_bits > 0 ? 1 << cache_bits : 0;
      const std::array<int, 5> sizes{literals + length_symbols + cache_size, literals, literals,
                                     literals, distance_symbols};
      for (std::size_t i = 0; i < group.size(); ++i) group[i] = read_code(sizes[i]);
      require_bits();
    }
    if (!is_main)
      take(std::uint64_t(width) * std::uint64_t(height) * sizeof(Argb), "the parts of an image");
    std::vector<Argb> pixels(std::size_t(width) * std::size_t(height));
    fill(pixels, width, cache_bits, region_bits, regions, codes);
    return pixels;
  }

  void fill(std::vector<Argb>& pixels, int width, int cache_bits, int region_bits,
            const std::vector<Argb>& regions, const std::vector<CodeGroup>& codes) {
    std::array<Argb, std::size_t(1) << max_cache_bits> cache{};
    const auto cache_place = [&](Argb pixel) { return 0x1e35a7bdu * pixel >> (32 - cache_bits); };
    const std::size_t columns = std::size_t(blocks(width, region_bits));
    const std::size_t block_mask = (std::size_t(1) << region_bits) - 1;
    std::size_t at = 0, x = 0, y = 0;
    const CodeGroup* group = codes.data();
    bool is_new_block = true;
    while (at < pixels.size()) {
      if (!regions.empty() && (is_new_block || (x & block_mask) == 0))
        group = &codes[regions[(y >> region_bits) * columns + (x >> region_bits)]];
      is_new_block = false;
      const int symbol = (*group)[0].read(in_);
      if (symbol >= literals && symbol < literals + length_symbols) {
        const std::size_t length = prefixed(symbol - literals);
        const std::size_t distance = distance_of(prefixed((*group)[4].read(in_)), width);
        if (distance > at || length > pixels.size() - at) fail("a copy leaves the image");
        for (std::size_t i = 0; i < length; ++i, ++at) {
          pixels[at] = pixels[at - distance];
          if (cache_bits > 0) cache[cache_place(pixels[at])] = pixels[at];
        }
        x += length;
        is_new_block = true;
        if (x >= std::size_t(width)) {
          y += x / std::size_t(width);
          x %= std::size_t(width);
          require_bits();
        }
        continue;
      }
      Argb pixel = 0;
      if (symbol < literals) {
        pixel = Argb(symbol) << 8;
        pixel |= Argb((*group)[1].read(in_)) << 16;
        pixel |= Argb((*group)[2].read(in_));
        pixel |= Argb((*group)[3].read(in_)) << 24;
      } else {
        pixel = cache[std::size_t(symbol - literals - length_symbols)];
      }
      if (cache_bits > 0) cache[cache_place(pixel)] = pixel;
      pixels[at++] = pixel;
      if (++x == std::size_t(width)) {
        x = 0;
        ++y;
        require_bits();
      }
    }
    require_bits();
  }

  /// A length or distance from its prefix symbol and further bits.
  std::size_t prefixed(int symbol) {
    if (symbol < 4) return std::size_t(symbol) + 1;
    const int bits = (symbol - 2) >> 1;
    return (std::size_t(2 + (symbol & 1)) << bits) + in_.read(bits) + 1;
  }

  static std::size_t distance_of(std::size_t code, int width) {
    if (code > near_pixels.size()) return code - near_pixels.size();
    const auto [x, y] = near_pixels[code - 1];
    return std::size_t(std::max(1, x + y * width));
  }

  PrefixCode read_code(int alphabet) {
    std::array<std::uint8_t, literals + length_symbols + (1 << max_cache_bits)> room{};
    const auto lengths = std::span(room).first(std::size_t(alphabet));
    if (in_.read(1)) {
      const bool has_two = in_.read(1);
      const bool has_8_bits = in_.read(1);
      for (int i = 0; i <= int(has_two); ++i) {
        const std::uint32_t symbol = in_.read(i > 0 || has_8_bits ? 8 : 1);
        if (symbol >= lengths.size()) fail("a code has a symbol outside its alphabet");
        lengths[symbol] = 1;
      }
    } else {
      read_lengths(lengths);
    }
    return code_of(lengths);
  }

  void read_lengths(std::span<std::uint8_t> lengths) {
    constexpr std::array<std::uint8_t, 19> order{17, 18, 0, 1,  2,  3,  4,  5,  16, 6,
                                                 7,  8,  9, 10, 11, 12, 13, 14, 15};
    std::array<std::uint8_t, 19> of_lengths{};
    const std::size_t stored = 4 + in_.read(4);
    for (std::size_t i = 0; i < stored; ++i) of_lengths[order[i]] = std::uint8_t(in_.read(3));
    const PrefixCode code = code_of(of_lengths);
    std::size_t left = lengths.size();
    if (in_.read(1)) {
      const int bits = 2 + 2 * int(in_.read(3));
      left = 2 + in_.read(bits);
      if (left > lengths.size()) fail("a code has more lengths than symbols");
    }
    std::uint8_t previous = 8;
    for (std::size_t at = 0; at < lengths.size() && left > 0; --left) {
      const int symbol = code.read(in_);
      if (symbol <= max_code_length) {
        lengths[at++] = std::uint8_t(symbol);
        if (symbol > 0) previous = std::uint8_t(symbol);
        continue;
      }
      const std::size_t times = symbol == 16   ? 3 + in_.read(2)
                                : symbol == 17 ? 3 + in_.read(3)
                                               : 11 + in_.read(7);
      if (times > lengths.size() - at) fail("a code has more lengths than symbols");
      std::fill_n(lengths.begin() + std::ptrdiff_t(at), times,
                  symbol == 16 ? previous : std::uint8_t(0));
      at += times;
    }
  }

  PrefixCode code_of(std::span<const std::uint8_t> lengths) {
    PrefixCode code;
    std::size_t used = 0;
    int longest = 0;
    for (const std::uint8_t length : lengths) {
      if (length == 0) continue;
      ++code.counts[length];
      ++used;
      longest = std::max(longest, int(length));
    }
    if (used == 0) fail("a code has no symbol");
    if (used == 1) {
      const auto only = std::find_if(lengths.begin(), lengths.end(), [](auto l) { return l > 0; });
      code.table = {{std::uint16_t(only - lengths.begin()), 0}};
      return code;
    }
    // The next free code of each length, and a check that the codes fill the tree exactly.
    std::array<std::uint32_t, max_code_length + 2> next{};
    std::array<std::size_t, max_code_length + 2> place{};
    for (std::size_t l = 1; l <= max_code_length; ++l) {
      next[l + 1] = (next[l] + code.counts[l]) << 1;
      place[l + 1] = place[l] + code.counts[l];
    }
    if (next[max_code_length + 1] != 2u << max_code_length)
      fail("a prefix code is incomplete or has too many codes");
    code.bits = std::min(longest, PrefixCode::table_bits);
    take((sizeof(PrefixCode::Entry) << code.bits) + used * sizeof(std::uint16_t),
         "the codes of an image");
    code.table.resize(std::size_t(1) << code.bits);
    if (longest > code.bits) code.symbols.resize(used);
    for (std::size_t symbol = 0; symbol < lengths.size(); ++symbol) {
      const std::uint8_t length = lengths[symbol];
      if (length == 0) continue;
      const std::uint32_t bits = next[length]++;
      const PrefixCode::Entry entry{std::uint16_t(symbol), length};
      if (!code.symbols.empty()) code.symbols[place[length]++] = entry.symbol;
      // The first bit is the lowest of the index.
      std::uint32_t index = 0;
      for (int b = 0; b < std::min(int(length), code.bits); ++b)
        index |= (bits >> (length - 1 - b) & 1) << b;
      for (; index < code.table.size(); index += 1u << std::min(int(length), code.bits))
        code.table[index] = entry;
    }
    return code;
  }

  Bits in_;
  const std::string& name_;
  MemoryBudget budget_;
};

bool has_tag(std::span<const std::byte> bytes, std::size_t at, std::string_view tag) {
  for (std::size_t i = 0; i < tag.size(); ++i)
    if (at + i >= bytes.size() || bytes[at + i] != std::byte(tag[i])) return false;
  return true;
}

}  // namespace
}  // namespace vp8l

std::optional<std::span<const std::byte>> vp8l_stream(std::span<const std::byte> webp,
                                                      const std::string& name) {
  using vp8l::has_tag;
  if (!has_tag(webp, 0, "RIFF") || !has_tag(webp, 8, "WEBP")) return std::nullopt;
  for (std::size_t at = 12; webp.size() - at >= 8;) {
    const auto content = webp.subspan(at + 8);
    const std::uint64_t size = little_number(webp.subspan(at), 4, 4);
    if (has_tag(webp, at, "VP8L")) {
      if (size + size % 2 > content.size())
        throw InputError({name}, "the WebP image is damaged: it ends early");
      return content.first(std::size_t(size));
    }
    if (has_tag(webp, at, "ANIM") || has_tag(webp, at, "VP8 ")) return std::nullopt;
    const std::uint64_t padded = size + size % 2;
    if (padded >= content.size()) return std::nullopt;
    at += 8 + std::size_t(padded);
  }
  return std::nullopt;
}

Image8 decode_vp8l(std::span<const std::byte> stream, const std::string& name,
                   MemoryBudget budget) {
  return vp8l::Decoder(stream, name, std::move(budget)).decode();
}

}  // namespace tureen
