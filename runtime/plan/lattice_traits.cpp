#include "runtime/plan/lattice_traits.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "scene/lattice.hpp"

namespace tureen {

namespace {

constexpr int channels = LatticeTexture::channels;

/// Measures the texels of one face. `scale`: factor from stored values to [0, 1].
template <class Value>
struct FaceMeasurement {
  bool constant = true;
  float feature_residual = 0;
  float alpha_residual = 0;
  bool opaque = true;

  FaceMeasurement(const Value* texels, int level, float scale) {
    const int n = lattice::resolution(level);
    const Value* corner0 = texels + lattice::texel_index(n, 0) * channels;
    const Value* corner1 = texels + lattice::texel_index(0, n) * channels;
    const Value* corner2 = texels;
    for (int y = 0; y <= n; ++y)
      for (int x = 0; x + y <= n; ++x) {
        const Value* texel = texels + lattice::texel_index(x, y) * channels;
        const float b0 = float(x) / float(n), b1 = float(y) / float(n);
        for (int c = 0; c < channels; ++c) {
          constant = constant && texel[c] == texels[c];
          const float affine =
              b0 * float(corner0[c]) + b1 * float(corner1[c]) + (1 - b0 - b1) * float(corner2[c]);
          const float residual = std::abs(affine - float(texel[c])) * scale;
          float& worst = c == LatticeTexture::features ? alpha_residual : feature_residual;
          worst = std::max(worst, residual);
        }
        opaque = opaque && float(texel[LatticeTexture::features]) * scale >= alpha_threshold;
      }
  }
};

template <class Value>
LatticeTraits measure_values(const LatticeTexture& texture, const std::vector<Value>& values,
                             std::span<const std::uint32_t> faces) {
  const float scale = sizeof(Value) == 1 ? 1.0f / 255.0f : 1.0f;
  // Rounding of an affine alpha: a few ulps of 1.
  constexpr float alpha_tolerance = 1e-6f;
  LatticeTraits traits;
  traits.affine_residual.resize(faces.size());
  traits.ranges.fill({INFINITY, -INFINITY});
  traits.lowest_level = faces.empty() ? 0 : lattice::max_level;
  std::vector<std::pair<std::uint64_t, std::uint64_t>> runs(faces.size());  // first, end
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const LatticePatch& patch = texture.patches[faces[i]];
    const int level = int(patch.level);
    const Value* face_texels = &values[std::size_t(patch.first_texel) * channels];
    runs[i] = {patch.first_texel, patch.first_texel + std::uint64_t(lattice::texel_count(level))};
    traits.lowest_level = std::min(traits.lowest_level, level);
    traits.highest_level = std::max(traits.highest_level, level);
    for (std::uint32_t k = 0; k < lattice::texel_count(level); ++k)
      for (int c = 0; c < LatticeTexture::features; ++c) {
        const float value = float(face_texels[k * channels + c]) * scale;
        traits.ranges[c].low = std::min(traits.ranges[c].low, value);
        traits.ranges[c].high = std::max(traits.ranges[c].high, value);
      }
    const FaceMeasurement<Value> face(face_texels, level, scale);
    traits.constant_faces += face.constant ? 1 : 0;
    const bool same_cut_out = face.opaque || face.alpha_residual <= alpha_tolerance;
    traits.affine_residual[i] = same_cut_out ? face.feature_residual : INFINITY;
  }
  if (faces.empty()) traits.ranges.fill({});
  traits.ranges[LatticeTexture::features] = {};  // lattices have seven features
  std::sort(runs.begin(), runs.end());
  traits.shares_texels =
      std::adjacent_find(runs.begin(), runs.end(), [](const auto& run, const auto& next) {
        return next.first < run.second;
      }) != runs.end();
  return traits;
}

}  // namespace

LatticeTraits measure(const LatticeTexture& texture, std::span<const std::uint32_t> faces) {
  return std::visit([&](const auto& values) { return measure_values(texture, values, faces); },
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
