// Arithmetic in 16-bit floats, as on a device where mediump is 16 bits. Tests of numerics compare
// our shaders with it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <span>
#include <utility>

#include "scene/color_mlp.hpp"
#include "scene/spherical_harmonics.hpp"

namespace tureen::test {

inline float rounded_to_half(float value) { return glm::unpackHalf1x16(glm::packHalf1x16(value)); }

/// As evaluate(), with weights, inputs of layers and every multiply-add rounded to a half; sigmoid
/// and blend in float.
inline glm::dvec3 evaluate_in_halves(const ColorMlp& mlp, std::span<const double> features,
                                     glm::dvec3 to_eye) {
  std::array<float, ColorMlp::max_width> x{}, y{};
  const auto count = std::size_t(mlp.feature_count());
  for (std::size_t i = 0; i < count; ++i) x[i] = float(features[i]);
  const glm::vec3 d(mlp.view == ViewConvention::surface_to_eye ? to_eye : -to_eye);
  if (mlp.encoding == DirectionEncoding::xyz)
    for (int i = 0; i < 3; ++i) x[count + std::size_t(i)] = d[i];
  if (mlp.encoding == DirectionEncoding::harmonics2) {
    const auto basis = harmonics::basis(d);
    for (std::size_t i = 0; i < 9; ++i) x[count + i] = basis[i];
  }
  for (const DenseLayer& layer : mlp.layers) {
    const auto inputs = std::size_t(layer.inputs);
    for (std::size_t i = 0; i < inputs; ++i) x[i] = rounded_to_half(x[i]);
    const bool last = &layer == &mlp.layers.back();
    for (std::size_t o = 0; o < std::size_t(layer.outputs); ++o) {
      float sum = rounded_to_half(layer.biases[o]);
      // Products of halves are exact in float, so each step has one rounding, like a fused
      // multiply-add.
      for (std::size_t i = 0; i < inputs; ++i)
        sum = rounded_to_half(sum + rounded_to_half(layer.weights[o * inputs + i]) * x[i]);
      y[o] = last ? 1.0f / (1.0f + std::exp(-sum)) : std::max(sum, 0.0f);
    }
    std::swap(x, y);
  }
  const glm::vec3 predicted(x[0], x[1], x[2]);
  if (!mlp.blend_channel) return glm::dvec3(predicted);
  const auto blend = float(features[std::size_t(*mlp.blend_channel)]);
  const glm::vec3 base(features[0], features[1], features[2]);
  return glm::dvec3((1.0f - blend) * base + blend * predicted);
}

}  // namespace tureen::test
