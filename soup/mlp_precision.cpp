#include "soup/mlp_precision.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "soup/quantise.hpp"
#include "soup/spherical_harmonics.hpp"

namespace tureen {

namespace {

float rounded_to_half(float value) { return float_from_half(half_from_float(value)); }

/// To q scale with q in -127..127, the scale being that of the largest.
void round_symmetrically(std::span<float> values) {
  float largest = 0;
  for (const float value : values) largest = std::max(largest, std::abs(value));
  if (largest == 0) return;
  for (float& value : values) value = float(quantised_signed(value, largest)) * (largest / 127.0f);
}

bool rounds_to_half(MlpPrecision precision) {
  return precision == MlpPrecision::half_weights || precision == MlpPrecision::half;
}

}  // namespace

const char* name_of(MlpPrecision precision) {
  constexpr const char* names[] = {"exact", "float32",      "half_weights",
                                   "half",  "int8_weights", "int8"};
  return names[int(precision)];
}

EmulatedMlp::EmulatedMlp(ColorMlp mlp, MlpPrecision precision)
    : mlp_(std::move(mlp)), precision_(precision) {
  for (DenseLayer& layer : mlp_.layers) {
    if (rounds_to_half(precision)) {
      for (auto* values : {&layer.weights, &layer.biases})
        for (float& value : *values) value = rounded_to_half(value);
    } else if (precision == MlpPrecision::int8_weights || precision == MlpPrecision::int8) {
      round_symmetrically(layer.weights);
    }
  }
}

glm::dvec3 EmulatedMlp::operator()(std::span<const double> features, glm::dvec3 to_eye) const {
  if (precision_ == MlpPrecision::exact) return evaluate(mlp_, features, to_eye);
  std::array<float, ColorMlp::max_width> x{}, y{};
  const int feature_count = mlp_.feature_count();
  for (int i = 0; i < feature_count; ++i) x[i] = float(features[i]);
  const glm::vec3 d(mlp_.view == ViewConvention::surface_to_eye ? to_eye : -to_eye);
  if (mlp_.encoding == DirectionEncoding::xyz)
    for (int i = 0; i < 3; ++i) x[feature_count + i] = d[i];
  if (mlp_.encoding == DirectionEncoding::harmonics2) {
    const auto basis = harmonics::basis(d);
    for (int i = 0; i < 9; ++i) x[feature_count + i] = basis[i];
  }
  const bool halves = precision_ == MlpPrecision::half;
  const auto kept = [&](float value) { return halves ? rounded_to_half(value) : value; };
  for (const DenseLayer& layer : mlp_.layers) {
    if (rounds_to_half(precision_))
      for (int i = 0; i < layer.inputs; ++i) x[i] = rounded_to_half(x[i]);
    if (precision_ == MlpPrecision::int8)
      round_symmetrically(std::span(x).first(std::size_t(layer.inputs)));
    const bool last = &layer == &mlp_.layers.back();
    for (int o = 0; o < layer.outputs; ++o) {
      float sum = layer.biases[o];
      const float* row = &layer.weights[std::size_t(o) * layer.inputs];
      // Products of halves are exact in float: one rounding a step, as a fused multiply-add has.
      for (int i = 0; i < layer.inputs; ++i) sum = kept(sum + row[i] * x[i]);
      y[o] = last ? 1.0f / (1.0f + std::exp(-sum)) : std::max(sum, 0.0f);
    }
    std::swap(x, y);
  }
  const glm::vec3 predicted(x[0], x[1], x[2]);
  if (!mlp_.blend_channel) return glm::dvec3(predicted);
  const float blend = float(features[*mlp_.blend_channel]);
  const glm::vec3 base(features[0], features[1], features[2]);
  return glm::dvec3((1.0f - blend) * base + blend * predicted);
}

}  // namespace tureen
