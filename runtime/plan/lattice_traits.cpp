#include "runtime/plan/lattice_traits.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "scene/lattice.hpp"

namespace tureen {

namespace {

constexpr int channels = LatticeTexture::channels;

/// Factor from stored values to [0, 1].
template <class Value>
constexpr float scale_of = sizeof(Value) == 1 ? 1.0f / 255.0f : 1.0f;

/// The channels of consecutive texels in a vector of the processor; GCC and Clang know the
/// attribute.
template <class Value, int count>
struct Texels {
  using Vector __attribute__((vector_size(count * channels * sizeof(Value)))) = Value;
  Vector values;

  explicit Texels(Value fill) : values(fill - Vector{}) {}
  explicit Texels(const Value* from) { std::memcpy(&values, from, sizeof values); }
  /// NaN changes nothing.
  void lower(const Texels& other) { values = other.values < values ? other.values : values; }
  void raise(const Texels& other) { values = other.values > values ? other.values : values; }
};

template <class Value>
struct Texel : Texels<Value, 1> {
  using Texels<Value, 1>::Texels;
  float operator[](int channel) const { return float(this->values[channel]) * scale_of<Value>; }
};

/// The range of each channel, of texels that are added face by face.
template <class Value>
class Ranges {
 public:
  /// `count` is at least 3, the texels of level 0.
  void add(const Value* texels, std::size_t count) {
    Block low = low_, high = high_;  // in registers: a member might be one of the texels
    // The last block may overlap the one before: a texel that is added twice changes nothing.
    const Value* last = texels + (count - block_texels) * channels;
    for (const Value* at = texels;; at = std::min(at + block_texels * channels, last)) {
      const Block block(at);
      low.lower(block);
      high.raise(block);
      if (at == last) break;
    }
    low_ = low;
    high_ = high;
  }

  FeatureRange of(int channel) const {
    Value low = low_.values[channel], high = high_.values[channel];
    for (int c = channel; c < block_texels * channels; c += channels) {
      low = std::min(low, Value(low_.values[c]));
      high = std::max(high, Value(high_.values[c]));
    }
    return {float(low) * scale_of<Value>, float(high) * scale_of<Value>};
  }

 private:
  /// 16 bytes, the size of vectors in WebAssembly, or a texel.
  static constexpr int block_texels = sizeof(Value) == 1 ? 2 : 1;
  using Block = Texels<Value, block_texels>;
  using Limits = std::numeric_limits<Value>;
  static constexpr bool floats = Limits::has_infinity;
  Block low_{floats ? Limits::infinity() : Limits::max()};
  Block high_{floats ? -Limits::infinity() : Limits::min()};
};

template <class Value>
LatticeTraits measure_values(const LatticeTexture& texture, const std::vector<Value>& values,
                             std::span<const std::uint32_t> faces) {
  LatticeTraits traits;
  if (faces.empty()) {
    traits.ranges.fill({});
    return traits;
  }
  const auto texels_of = [&](std::uint32_t face) {
    return &values[std::size_t(texture.patches[face].first_texel) * channels];
  };
  traits.lowest_level = lattice::max_level;
  Ranges<Value> ranges;
  std::vector<std::pair<std::uint64_t, std::uint64_t>> runs(faces.size());  // first, end
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const LatticePatch& patch = texture.patches[faces[i]];
    const int level = int(patch.level);
    const std::size_t count = lattice::texel_count(level);
    runs[i] = {patch.first_texel, patch.first_texel + std::uint64_t(count)};
    traits.lowest_level = std::min(traits.lowest_level, level);
    traits.highest_level = std::max(traits.highest_level, level);
    const Value* first = texels_of(faces[i]);
    ranges.add(first, count);
    traits.constant_faces += std::equal(first + channels, first + count * channels, first) ? 1 : 0;
  }
  for (int c = 0; c < LatticeTexture::features; ++c) traits.ranges[c] = ranges.of(c);
  traits.ranges[LatticeTexture::features] = {};  // lattices have seven features
  std::sort(runs.begin(), runs.end());
  traits.shares_texels =
      std::adjacent_find(runs.begin(), runs.end(), [](const auto& run, const auto& next) {
        return next.first < run.second;
      }) != runs.end();
  return traits;
}

/// `texels`: of one face.
template <class Value>
std::optional<float> affine_residual_of(const Value* texels, int level, float largest) {
  // Rounding of an affine alpha: a few ulps of 1.
  constexpr float alpha_tolerance = 1e-6f;
  const int n = lattice::resolution(level);
  const Texel<Value> corner0(texels + lattice::texel_index(n, 0) * channels);
  const Texel<Value> corner1(texels + lattice::texel_index(0, n) * channels);
  const Texel<Value> corner2(texels);
  float worst = 0;
  bool opaque = true, affine_alpha = true;
  for (int y = 0; y <= n; ++y)
    for (int x = 0; x + y <= n; ++x) {
      const Texel<Value> texel(texels + lattice::texel_index(x, y) * channels);
      const float b0 = float(x) / float(n), b1 = float(y) / float(n);
      const auto residual = [&](int c) {
        const float affine = b0 * float(corner0.values[c]) + b1 * float(corner1.values[c]) +
                             (1 - b0 - b1) * float(corner2.values[c]);
        return std::abs(affine - float(texel.values[c])) * scale_of<Value>;
      };
      for (int c = 0; c < LatticeTexture::features; ++c) worst = std::max(worst, residual(c));
      opaque = opaque && texel[LatticeTexture::features] >= alpha_threshold;
      affine_alpha = affine_alpha && residual(LatticeTexture::features) <= alpha_tolerance;
      if (worst > largest || !(opaque || affine_alpha)) return std::nullopt;
    }
  return worst;
}

}  // namespace

LatticeTraits measure(const LatticeTexture& texture, std::span<const std::uint32_t> faces) {
  return std::visit([&](const auto& values) { return measure_values(texture, values, faces); },
                    texture.texels);
}

std::optional<float> affine_residual(const LatticeTexture& texture, std::uint32_t face,
                                     float largest) {
  const LatticePatch& patch = texture.patches[face];
  return std::visit(
      [&](const auto& values) {
        return affine_residual_of(&values[std::size_t(patch.first_texel) * channels],
                                  int(patch.level), largest);
      },
      texture.texels);
}

double network_gain(const ColorMlp& mlp, int first, int end) {
  double gain = 0.25;
  for (const DenseLayer& layer : mlp.layers) {
    const bool of_features = &layer == &mlp.layers.front();
    const int begin = of_features ? first : 0;
    const int columns = of_features ? std::min(end, mlp.feature_count()) : layer.inputs;
    double largest = 0;
    for (int o = 0; o < layer.outputs; ++o) {
      double sum = 0;
      for (int i = begin; i < columns; ++i)
        sum += std::abs(double(layer.weights[std::size_t(o) * layer.inputs + i]));
      largest = std::max(largest, sum);
    }
    gain *= largest;
  }
  return gain;
}

double base_from_network(const FeatureRanges& ranges) {
  double apart = 1.0;
  for (std::size_t c = 0; c < 3; ++c)
    apart = std::max({apart, double(ranges[c].high), 1.0 - double(ranges[c].low)});
  return apart;
}

double color_gain(const ColorMlp& mlp, const FeatureRanges& ranges) {
  const double gain = network_gain(mlp, 0, mlp.feature_count());
  if (!mlp.blend_channel) return gain;
  // The colour is (1 - r) base + r mlp. The base changes by 1, mlp by its gain. A change of r by 1
  // changes the colour by the difference between base and mlp.
  return std::max(1.0, gain) + base_from_network(ranges);
}

}  // namespace tureen
