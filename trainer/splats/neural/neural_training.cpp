#include "trainer/splats/neural/neural_training.hpp"

#include <algorithm>
#include <cmath>

#include "trainer/splats/neural/neural_start.hpp"

namespace tureen::trainer {

namespace neural_row = splatting::neural_row;

NeuralStep NeuralTraining::step_of(const NeuralConfig& config, double half_side, double,
                                   std::size_t count) {
  return {.rates = {},
          .min_log_axis = float(std::log(config.min_axis * half_side)),
          .max_log_axis = float(std::log(config.max_axis * half_side)),
          .anisotropy = config.anisotropy_weight / float(std::max<std::size_t>(count, 1))};
}

float NeuralTraining::rate_factor(const NeuralConfig&, std::size_t kind, std::size_t count) {
  const std::size_t first = kinds[kind].first;
  const double ratio = std::min(1.0, reference_count / double(std::max<std::size_t>(count, 1)));
  if (first >= neural_row::harmonics || first == neural_row::rotation) return 1;
  return float(std::pow(ratio, first == neural_row::center ? 0.75 : 0.33));
}

DensifyReport NeuralTraining::densify(const NeuralConfig& config, int, int, Random& random,
                                      NeuralParameters& parameters, SplatMemory& memory) {
  return densify_densities({.max_splats = config.max_splats, .growth = config.growth}, random,
                           parameters, memory);
}

double NeuralTraining::size_at_point(const NeuralConfig& config, double distance, double,
                                     double half_side) {
  return std::clamp(distance, double(config.min_axis) * half_side,
                    double(config.max_axis) * half_side);
}

void NeuralTraining::put(const NeuralConfig& config, const ColoredPoint& point, double size,
                         Random& random, std::size_t place, NeuralParameters& parameters) {
  for (int axis = 0; axis < 3; ++axis) {
    parameters.trained(neural_row::center + std::size_t(axis))[place] = float(point.position[axis]);
    parameters.trained(neural_row::semi_axes + std::size_t(axis))[place] = float(std::log(size));
  }
  parameters.trained(neural_row::rotation + 3)[place] = 1;
  parameters.set_color(place, point.color);
  set_first_network(offset_for(config.first_opacity, 2), random, place, parameters);
  parameters.activate(place);
}

Primitives NeuralTraining::primitives(const NeuralConfig&, const NeuralParameters& parameters,
                                      std::span<const float>) {
  NeuralParameters kept = parameters;
  std::vector<std::uint32_t> drawn;
  for (std::uint32_t i = 0; i < parameters.count(); ++i)
    if (parameters.is_finite(i)) drawn.push_back(i);
  kept.reorder(drawn);
  return kept.splats();
}

}  // namespace tureen::trainer
