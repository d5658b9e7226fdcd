#include "runtime/plan/view_dependence.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/spherical_harmonics.hpp"

namespace tureen {

namespace {

double norm(const float* values, int count) {
  double sum = 0;
  for (int i = 0; i < count; ++i) sum += double(values[i]) * double(values[i]);
  return std::sqrt(sum);
}

/// Largest absolute contribution of the direction to a neuron's sum, without the constant band.
double direction_reach(DirectionEncoding encoding, const float* weights) {
  if (encoding == DirectionEncoding::none) return 0.0;
  if (encoding == DirectionEncoding::xyz) return norm(weights, 3);
  double reach = 0;
  for (int l = 1; l <= 2; ++l)
    reach += std::sqrt((2 * l + 1) / (4 * std::numbers::pi)) * norm(weights + l * l, 2 * l + 1);
  return reach;
}

}  // namespace

double view_dependence(const ColorMlp& mlp) {
  const DenseLayer& first = mlp.layers.front();
  std::vector<double> reach;
  for (int o = 0; o < first.outputs; ++o)
    reach.push_back(direction_reach(
        mlp.encoding, first.weights.data() + std::size_t(o) * first.inputs + mlp.feature_count()));
  for (std::size_t l = 1; l < mlp.layers.size(); ++l) {
    const DenseLayer& layer = mlp.layers[l];
    std::vector<double> next(std::size_t(layer.outputs), 0.0);
    for (int o = 0; o < layer.outputs; ++o)
      for (int i = 0; i < layer.inputs; ++i)
        next[o] += std::abs(double(layer.weights[std::size_t(o) * layer.inputs + i])) *
                   reach[std::size_t(i)];
    reach = std::move(next);
  }
  return 0.25 * *std::max_element(reach.begin(), reach.end());
}

ColorMlp without_direction(const ColorMlp& mlp) {
  ColorMlp result = mlp;
  result.encoding = DirectionEncoding::none;
  DenseLayer& first = result.layers.front();
  first.inputs = mlp.feature_count();
  first.weights.clear();
  const DenseLayer& full = mlp.layers.front();
  for (int o = 0; o < full.outputs; ++o) {
    const float* weights = full.weights.data() + std::size_t(o) * full.inputs;
    first.weights.insert(first.weights.end(), weights, weights + first.inputs);
    if (mlp.encoding == DirectionEncoding::harmonics2)
      first.biases[std::size_t(o)] += float(harmonics::y00) * weights[first.inputs];
  }
  return result;
}

}  // namespace tureen
