// The channels of lattice texels in vectors of the processor, and their ranges.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <limits>

#include "scene/triangle_soup.hpp"

namespace tureen {

/// Factor from stored values, bytes or floats, to [0, 1].
template <class Value>
constexpr float scale_of = sizeof(Value) == 1 ? 1.0f / 255.0f : 1.0f;

/// The channels of consecutive texels; GCC and Clang know the attribute.
template <class Value, int count>
struct Texels {
  using Vector __attribute__((vector_size(count * LatticeTexture::channels * sizeof(Value)))) =
      Value;
  Vector values;

  explicit Texels(Value fill) : values(fill - Vector{}) {}
  explicit Texels(const Value* from) { std::memcpy(&values, from, sizeof values); }
  /// NaN changes nothing.
  void lower(const Texels& other) { values = other.values < values ? other.values : values; }
  void raise(const Texels& other) { values = other.values > values ? other.values : values; }
};

/// The smallest and the largest value of each channel, without NaN.
template <class Value>
class TexelRanges {
 public:
  /// Adds the texels of a face: at least 3, those of level 0. Never inline: browsers optimise a
  /// function after many calls, so a loop in a function that is called once stays slow.
  [[gnu::noinline]] void add(const Value* texels, std::size_t count) {
    Block low = low_, high = high_;  // in registers: a member might be one of the texels
    // The last block may overlap the one before: a texel that is added twice changes nothing.
    const Value* last = texels + (count - block_texels) * LatticeTexture::channels;
    for (const Value* at = texels;; at = std::min(at + block_values, last)) {
      const Block block(at);
      low.lower(block);
      high.raise(block);
      if (at == last) break;
    }
    low_ = low;
    high_ = high;
  }

  Value low(int channel) const {
    Value lowest = low_.values[channel];
    for (int i = channel; i < block_values; i += LatticeTexture::channels)
      lowest = std::min(lowest, Value(low_.values[i]));
    return lowest;
  }
  Value high(int channel) const {
    Value highest = high_.values[channel];
    for (int i = channel; i < block_values; i += LatticeTexture::channels)
      highest = std::max(highest, Value(high_.values[i]));
    return highest;
  }

 private:
  /// 16 bytes, the size of vectors in WebAssembly, or a texel.
  static constexpr int block_texels = sizeof(Value) == 1 ? 2 : 1;
  static constexpr int block_values = block_texels * LatticeTexture::channels;
  using Block = Texels<Value, block_texels>;
  using Limits = std::numeric_limits<Value>;
  Block low_{Limits::has_infinity ? Limits::infinity() : Limits::max()};
  Block high_{Limits::has_infinity ? -Limits::infinity() : Limits::min()};
};

}  // namespace tureen
