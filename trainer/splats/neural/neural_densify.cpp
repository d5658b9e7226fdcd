#include "trainer/splats/neural/neural_densify.hpp"

#include <cmath>
#include <glm/gtc/quaternion.hpp>

namespace tureen::trainer {

namespace neural_row = splatting::neural_row;

namespace {

glm::vec3 log_axes_of(const NeuralParameters& parameters, std::size_t i) {
  const auto value = [&](std::size_t axis) {
    return parameters.trained(neural_row::semi_axes + axis)[i];
  };
  return {value(0), value(1), value(2)};
}

float largest_of(const glm::vec3& v) { return std::max(v.x, std::max(v.y, v.z)); }

}  // namespace

void reshape_density(const glm::vec3& offset, const glm::vec3& log_axes, std::size_t i,
                     NeuralParameters& parameters) {
  const float old_log = largest_of(log_axes_of(parameters, i));
  const float ratio = std::exp(largest_of(log_axes) - old_log), by_old = std::exp(-old_log);
  const auto value = [&](std::size_t r) -> float& { return parameters.trained(r)[i]; };
  for (std::size_t k = 0; k < splatting::neurons; ++k) {
    float along = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      float& frequency = value(neural_row::frequencies + 3 * k + axis);
      along += frequency * offset[int(axis)];
      frequency *= ratio;
    }
    value(neural_row::phases + k) += along * by_old;
    value(neural_row::amplitudes + k) *= ratio;
  }
  value(neural_row::offset) *= ratio;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    value(neural_row::center + axis) += offset[int(axis)];
    value(neural_row::semi_axes + axis) = log_axes[int(axis)];
  }
}

DensifyReport densify_densities(const NeuralDensifyOptions& options, Random& random,
                                NeuralParameters& parameters, SplatMemory& memory) {
  const auto split = [&](std::size_t parent, std::size_t place) {
    glm::vec3 log_axes = log_axes_of(parameters, parent);
    int longest = 0;
    for (int axis = 1; axis < 3; ++axis)
      if (log_axes[axis] > log_axes[longest]) longest = axis;
    const auto value = [&](std::size_t r) { return parameters.drawn.row(r)[parent]; };
    const glm::quat rotation(value(neural_row::rotation + 3), value(neural_row::rotation),
                             value(neural_row::rotation + 1), value(neural_row::rotation + 2));
    glm::vec3 along(0.0f);
    along[longest] = options.distance * std::exp(log_axes[longest]);
    const glm::vec3 offset = rotation * along;
    for (int axis = 0; axis < 3; ++axis)
      log_axes[axis] += std::log(axis == longest ? options.shrink_along : options.shrink_across);
    parameters.copy(parent, place);
    reshape_density(-offset, log_axes, parent, parameters);
    reshape_density(offset, log_axes, place, parameters);
  };
  return densify_splats(
      {.max_splats = options.max_splats, .growth = options.growth, .min_opacity = 0}, random,
      parameters, memory,
      [&](std::size_t i) { return memory.statistics.row(splat_statistic::motion)[i]; }, split);
}

}  // namespace tureen::trainer
