#include "runtime/plan/lattice_traits.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "runtime/plan/texel_ranges.hpp"
#include "scene/lattice.hpp"

namespace tureen {

namespace {

constexpr int channels = LatticeTexture::channels;

template <class Value>
struct Texel : Texels<Value, 1> {
  using Texels<Value, 1>::Texels;
  float operator[](int channel) const { return float(this->values[channel]) * scale_of<Value>; }
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
  TexelRanges<Value> ranges;
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
  for (int c = 0; c < LatticeTexture::features; ++c)
    traits.ranges[c] = {ranges.low(c) * scale_of<Value>, ranges.high(c) * scale_of<Value>};
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
