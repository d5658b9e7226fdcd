#include "trainer/diffsoup/mlp_parameters.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <span>

#include "trainer/common/random.hpp"

namespace tureen::trainer {

namespace {

constexpr int layer_inputs[] = {mlp_inputs, mlp_width, mlp_width};
constexpr int layer_outputs[] = {mlp_width, mlp_width, mlp_outputs};
constexpr std::uint64_t weights_stream = 1;

/// Calls visit(layer, its weights, its biases) for the three layers.
template <class Float, class Visit>
void for_each_layer(std::span<Float, trainer::mlp_parameters> parameters, const Visit& visit) {
  std::size_t at = 0;
  for (int layer = 0; layer < 3; ++layer) {
    const auto weights = std::size_t(layer_inputs[layer]) * layer_outputs[layer];
    const auto biases = std::size_t(layer_outputs[layer]);
    visit(layer, parameters.subspan(at, weights), parameters.subspan(at + weights, biases));
    at += weights + biases;
  }
  assert(at == parameters.size());
}

}  // namespace

MlpParameters initial_mlp(std::uint64_t seed) {
  Random random(seed, weights_stream);
  MlpParameters parameters{};
  for_each_layer(std::span(parameters), [&](int layer, auto weights, auto) {
    const bool last = layer == 2;
    const int fan = layer_inputs[layer] + (last ? layer_outputs[layer] : 0);
    const double bound = std::sqrt(6.0 / fan);
    for (float& weight : weights) weight = float(random.uniform(-bound, bound));
  });
  return parameters;
}

ColorMlp color_mlp(const MlpParameters& parameters) {
  ColorMlp mlp{.layers = {},
               .encoding = DirectionEncoding::harmonics2,
               .view = ViewConvention::surface_to_eye,
               .blend_channel = blend_channel};
  for_each_layer(std::span(parameters), [&](int layer, auto weights, auto biases) {
    mlp.layers.push_back({.inputs = layer_inputs[layer],
                          .outputs = layer_outputs[layer],
                          .weights = {weights.begin(), weights.end()},
                          .biases = {biases.begin(), biases.end()}});
  });
  return mlp;
}

std::optional<MlpParameters> parameters_of(const ColorMlp& mlp) {
  if (mlp.layers.size() != 3 || mlp.encoding != DirectionEncoding::harmonics2 ||
      mlp.blend_channel != blend_channel)
    return std::nullopt;
  for (int layer = 0; layer < 3; ++layer)
    if (mlp.layers[layer].inputs != layer_inputs[layer] ||
        mlp.layers[layer].outputs != layer_outputs[layer])
      return std::nullopt;
  MlpParameters parameters{};
  for_each_layer(std::span(parameters), [&](int layer, auto weights, auto biases) {
    std::ranges::copy(mlp.layers[layer].weights, weights.begin());
    std::ranges::copy(mlp.layers[layer].biases, biases.begin());
  });
  if (mlp.view == ViewConvention::eye_to_surface) {
    constexpr int first_harmonic = channels - 1;           // inputs: features, then harmonics
    for (int output = 0; output < mlp_width; ++output)     // of the first layer
      for (int band_one = 1; band_one <= 3; ++band_one) {  // the only odd band up to degree 2
        float& weight = parameters[output * mlp_inputs + first_harmonic + band_one];
        weight = -weight;
      }
  }
  return parameters;
}

}  // namespace tureen::trainer
