#include "scene/color_mlp.hpp"

#include <array>
#include <cassert>
#include <cmath>

#include "scene/spherical_harmonics.hpp"

namespace tureen {

std::optional<std::string> defect(const ColorMlp& mlp, int available_features) {
  if (mlp.layers.empty()) return "the color MLP has no layers";
  if (mlp.layers.size() > ColorMlp::max_layers)
    return "the color MLP has more than " + std::to_string(ColorMlp::max_layers) + " layers";
  int inputs = mlp.layers.front().inputs;
  for (std::size_t i = 0; i < mlp.layers.size(); ++i) {
    const DenseLayer& layer = mlp.layers[i];
    const std::string name = "layer " + std::to_string(i) + " of the color MLP";
    if (layer.inputs < 1 || layer.outputs < 1 || layer.inputs > ColorMlp::max_width ||
        layer.outputs > ColorMlp::max_width)
      return name + " has a width outside 1.." + std::to_string(ColorMlp::max_width);
    if (layer.inputs != inputs)
      return name + " has " + std::to_string(layer.inputs) + " inputs, expected " +
             std::to_string(inputs);
    const auto weights = static_cast<std::size_t>(layer.inputs) * layer.outputs;
    if (layer.weights.size() != weights || layer.biases.size() != std::size_t(layer.outputs))
      return name + " has a wrong number of weights or biases";
    for (const auto* values : {&layer.weights, &layer.biases})
      for (const float value : *values)
        if (!std::isfinite(value)) return name + " has a weight that is not finite";
    inputs = layer.outputs;
  }
  if (inputs != 3) return "the color MLP has " + std::to_string(inputs) + " outputs, not 3";
  if (mlp.feature_count() < 0 || mlp.feature_count() > available_features)
    return "the color MLP needs " + std::to_string(mlp.feature_count()) +
           " features, available: " + std::to_string(available_features);
  if (mlp.blend_channel && (*mlp.blend_channel < 0 || *mlp.blend_channel >= available_features ||
                            available_features < 3))
    return "the color MLP's blend channel is not one of the features";
  return std::nullopt;
}

glm::dvec3 evaluate(const ColorMlp& mlp, std::span<const double> features, glm::dvec3 to_eye) {
  assert(!defect(mlp, static_cast<int>(features.size())));
  std::array<double, ColorMlp::max_width> x{}, y{};
  const int feature_count = mlp.feature_count();
  for (int i = 0; i < feature_count; ++i) x[i] = features[i];
  const glm::dvec3 d = mlp.view == ViewConvention::surface_to_eye ? to_eye : -to_eye;
  if (mlp.encoding == DirectionEncoding::xyz)
    for (int i = 0; i < 3; ++i) x[feature_count + i] = d[i];
  if (mlp.encoding == DirectionEncoding::harmonics2) {
    const auto basis = harmonics::basis(d);
    for (int i = 0; i < 9; ++i) x[feature_count + i] = basis[i];
  }
  for (const DenseLayer& layer : mlp.layers) {
    const bool last = &layer == &mlp.layers.back();
    for (int o = 0; o < layer.outputs; ++o) {
      double sum = layer.biases[o];
      for (int i = 0; i < layer.inputs; ++i)
        sum += double(layer.weights[std::size_t(o) * layer.inputs + i]) * x[i];
      y[o] = last ? 1.0 / (1.0 + std::exp(-sum)) : std::max(sum, 0.0);
    }
    std::swap(x, y);
  }
  const glm::dvec3 predicted(x[0], x[1], x[2]);
  if (!mlp.blend_channel) return predicted;
  const double blend = features[*mlp.blend_channel];
  return (1.0 - blend) * glm::dvec3(features[0], features[1], features[2]) + blend * predicted;
}

}  // namespace tureen
