#include "trainer/splats/windows/window_densify.hpp"

#include <array>
#include <glm/geometric.hpp>

namespace tureen::trainer {

namespace {

float weight_of(WindowSampling sampling, const WindowParameters& parameters,
                const SplatMemory& memory, std::size_t i) {
  switch (sampling) {
    case WindowSampling::motion:
      return memory.statistics.row(splat_statistic::motion)[i];
    case WindowSampling::opacity:
    case WindowSampling::alternating:
      return parameters.opacity(i);
    case WindowSampling::inverse_sigma:
      break;
  }
  return 1 / parameters.drawn.row(splatting::window_row::sigma)[i];
}

void divide(WindowParameters& parameters, std::size_t parent, std::size_t place) {
  std::array<glm::vec3, 3> corners;
  for (std::size_t k = 0; k < 3; ++k) corners[k] = parameters.corner(parent, k);
  std::size_t from = 0;
  float longest = -1;
  for (std::size_t k = 0; k < 3; ++k) {
    const float length = glm::distance(corners[k], corners[(k + 1) % 3]);
    if (length > longest) longest = length, from = k;
  }
  const std::size_t to = (from + 1) % 3;
  parameters.copy(parent, place);
  const glm::vec3 middle = glm::mix(corners[from], corners[to], 0.5f);
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t row = splatting::window_row::corners + std::size_t(axis);
    parameters.trained(row + 3 * to)[parent] = middle[axis];
    parameters.trained(row + 3 * from)[place] = middle[axis];
  }
}

}  // namespace

DensifyReport densify_windows(const WindowDensifyOptions& options, Random& random,
                              WindowParameters& parameters, SplatMemory& memory) {
  return densify_splats(
      {.max_splats = options.max_splats,
       .growth = options.growth,
       .min_opacity = options.min_opacity},
      random, parameters, memory,
      [&](std::size_t i) { return weight_of(options.sampling, parameters, memory, i); },
      [&](std::size_t parent, std::size_t place) { divide(parameters, parent, place); });
}

}  // namespace tureen::trainer
