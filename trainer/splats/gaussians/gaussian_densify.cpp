#include "trainer/splats/gaussians/gaussian_densify.hpp"

#include <cmath>

namespace tureen::trainer {

namespace row = splatting::gaussian_row;

DensifyReport densify(const DensifyOptions& options, Random& random, GaussianParameters& parameters,
                      SplatMemory& memory) {
  const auto split = [&](std::size_t parent, std::size_t place) {
    std::size_t longest = 0;
    for (std::size_t axis = 1; axis < 3; ++axis)
      if (parameters.trained(row::scale_x + axis)[parent] >
          parameters.trained(row::scale_x + longest)[parent])
        longest = axis;
    const auto value = [&](std::size_t r) { return parameters.drawn.row(r)[parent]; };
    const glm::quat rotation(value(row::rotation_w), value(row::rotation_x), value(row::rotation_y),
                             value(row::rotation_z));
    glm::vec3 axis(0.0f);
    axis[int(longest)] = options.distance * value(row::scale_x + longest);
    const glm::vec3 offset = rotation * axis;
    for (std::size_t k = 0; k < 3; ++k)
      parameters.trained(row::scale_x + k)[parent] -=
          std::log(k == longest ? options.shrink_along : options.shrink_across);
    parameters.copy(parent, place);
    for (int k = 0; k < 3; ++k) {
      parameters.trained(row::x + std::size_t(k))[parent] -= offset[k];
      parameters.trained(row::x + std::size_t(k))[place] += offset[k];
    }
  };
  return densify_splats(
      {.max_splats = options.max_splats,
       .growth = options.growth,
       .min_opacity = options.min_opacity},
      random, parameters, memory,
      [&](std::size_t i) { return memory.statistics.row(splat_statistic::motion)[i]; }, split);
}

}  // namespace tureen::trainer
