#include "trainer/splats/gaussians/gaussian_training.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

namespace tureen::trainer {

namespace row = splatting::gaussian_row;

namespace {

/// The third scale of a disc: far below the smallest scale. The first step raises it to
/// GaussianStep::min_log_scale.
constexpr float flat_log_scale = -30;

}  // namespace

GaussianStep GaussianTraining::step_of(const GaussianConfig& config, double half_side, double,
                                       std::size_t) {
  return {.rates = {},
          .min_log_scale = float(std::log(config.min_scale * half_side)),
          .max_log_scale = float(std::log(config.max_scale * half_side))};
}

DensifyReport GaussianTraining::densify(const GaussianConfig& config, int, int, Random& random,
                                        GaussianParameters& parameters, SplatMemory& memory) {
  return trainer::densify({.max_splats = config.max_splats, .growth = config.growth}, random,
                          parameters, memory);
}

double GaussianTraining::size_at_point(const GaussianConfig& config, double distance, double,
                                       double half_side) {
  return std::clamp(distance, double(config.min_scale) * half_side,
                    double(config.max_scale) * half_side);
}

void GaussianTraining::put(const GaussianConfig& config, const ColoredPoint& point, double size,
                           Random& random, std::size_t place, GaussianParameters& parameters) {
  for (int axis = 0; axis < 3; ++axis) {
    parameters.trained(row::x + std::size_t(axis))[place] = float(point.position[axis]);
    parameters.trained(row::scale_x + std::size_t(axis))[place] = float(std::log(size));
  }
  parameters.set_color(place, point.color);
  parameters.trained(row::rotation_w)[place] = 1;
  if (config.flat) {
    const glm::dquat rotation(random.rotation());
    parameters.trained(row::rotation_x)[place] = float(rotation.x);
    parameters.trained(row::rotation_y)[place] = float(rotation.y);
    parameters.trained(row::rotation_z)[place] = float(rotation.z);
    parameters.trained(row::rotation_w)[place] = float(rotation.w);
    parameters.trained(row::scale_z)[place] = flat_log_scale;
  }
  parameters.trained(row::opacity)[place] =
      std::log(config.first_opacity / (1 - config.first_opacity));
  parameters.activate(place);
}

Primitives GaussianTraining::primitives(const GaussianConfig& config,
                                        const GaussianParameters& parameters,
                                        std::span<const float>) {
  const float min_alpha = with_training(
      config, []<class Training>() { return profile_named(Training::profile)->min_alpha; });
  GaussianParameters kept = parameters;
  std::vector<std::uint32_t> drawn;
  for (std::uint32_t i = 0; i < parameters.count(); ++i)
    if (parameters.is_finite(i) && parameters.opacity(i) >= min_alpha) drawn.push_back(i);
  kept.reorder(drawn);
  return kept.splats(config.flat);
}

}  // namespace tureen::trainer
