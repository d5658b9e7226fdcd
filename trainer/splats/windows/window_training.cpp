#include "trainer/splats/windows/window_training.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "scene/edit/opaque_windows.hpp"
#include "scene/edit/splat_edits.hpp"

namespace tureen::trainer {

namespace window_row = splatting::window_row;

namespace {

/// Steps between changes of the limits of opaque training; each change is a pass over all windows.
constexpr int steps_a_limit = 10;
/// Opacity reaches it: the next float to 1 would make the derivative of its logit infinite.
constexpr float last_solidity = 0.9999f;
/// The range that WindowParameters represent.
constexpr float lowest_sigma = 1.01f * sigma_floor;
const float highest_sigma = sigma_floor + std::exp(max_log_sigma);

}  // namespace

WindowStep WindowTraining::step_of(const WindowConfig& config, double, double done,
                                   std::size_t count) {
  const auto per_window = [&](float weight) {
    return weight / float(std::max(count, std::size_t(1)));
  };
  WindowStep step{.rates = {}};
  step.loss.opacity = per_window(config.opacity_weight);
  if (done < config.size_until) step.loss.inverse_area = per_window(config.size_weight);
  return step;
}

DensifyReport WindowTraining::densify(const WindowConfig& config, int step, int number,
                                      Random& random, WindowParameters& parameters,
                                      SplatMemory& memory) {
  WindowDensifyOptions options{
      .max_splats = config.max_splats, .growth = config.growth, .sampling = config.sampling};
  if (config.opaque && step >= config.prune_from * config.steps)
    options.min_opacity = config.min_opacity_before_opaque;
  if (config.sampling == WindowSampling::alternating && number % 2 == 0)
    options.sampling = WindowSampling::inverse_sigma;
  return densify_windows(options, random, parameters, memory);
}

void WindowTraining::limit(const WindowConfig& config, int step, WindowParameters& parameters) {
  const double done = double(step) / config.steps;
  if (!config.opaque || done < config.opaque_from) return;
  if (step % steps_a_limit != 0 && step != config.steps) return;
  const double part = std::clamp(
      (done - config.opaque_from) / (config.opaque_until - config.opaque_from), 0.0, 1.0);
  // A ramp is linear, with sigma 1. Its range narrows to 1 by equal factors in equal times.
  const auto limit_of_sigma = [&](float now) {
    return WindowParameters::log_of_sigma(float(std::pow(double(now), 1 - part)));
  };
  const float low = limit_of_sigma(lowest_sigma), high = limit_of_sigma(highest_sigma);
  const float solidity = std::max(float(part) * last_solidity, parameters.solidity);
  for (std::size_t i = 0; i < parameters.count(); ++i) {
    float& log_sigma = parameters.trained(window_row::sigma)[i];
    log_sigma = std::clamp(log_sigma, low, high);
  }
  // The opacity stays the same unless it is below the solidity.
  const bool rises = solidity > parameters.solidity;
  parameters.solidity = solidity;
  for (std::size_t i = 0; i < parameters.count(); ++i) {
    if (rises)
      parameters.trained(window_row::opacity)[i] = parameters.logit_of(parameters.opacity(i));
    parameters.activate(i);
  }
}

double WindowTraining::size_at_point(const WindowConfig& config, double distance, double spacing,
                                     double) {
  return config.first_size * 2 * (distance > 0 ? std::min(distance, 2 * spacing) : 2 * spacing);
}

void WindowTraining::put(const WindowConfig& config, const ColoredPoint& point, double size,
                         Random& random, std::size_t place, WindowParameters& parameters) {
  const glm::dmat3 rotation = random.rotation();
  glm::dvec3 corners[3];
  for (int k = 0; k < 3; ++k) {
    const double angle = k * 2.0943951023931953;  // a third of a turn
    corners[k] =
        point.position + rotation * glm::dvec3(size * std::cos(angle), size * std::sin(angle), 0);
  }
  put_window(config, corners, point.color, place, parameters);
}

Primitives WindowTraining::primitives(const WindowConfig& config,
                                      const WindowParameters& parameters,
                                      std::span<const float> evident) {
  Splats splats = parameters.splats();
  const bool becomes_soup = config.opaque && parameters.solidity >= solidity_of_triangles;
  const bool some_shown =
      std::any_of(evident.begin(), evident.end(), [](float e) { return e > 0; });
  std::vector<std::uint8_t> keeps(count(splats));
  for (std::size_t i = 0; i < keeps.size(); ++i)
    keeps[i] = parameters.is_finite(i) && parameters.opacity(i) >= splats.profile.min_alpha &&
               (!becomes_soup || !some_shown || evident[i] > 0);
  splats = keep_splats(std::move(splats), keeps);
  if (!becomes_soup) return splats;
  return to_opaque(std::move(splats)).soup;
}

void put_window(const WindowConfig& config, const glm::dvec3 (&corners)[3], const glm::vec3& color,
                std::size_t place, WindowParameters& parameters) {
  for (int axis = 0; axis < 3; ++axis)
    for (std::size_t k = 0; k < 3; ++k)
      parameters.trained(window_row::corners + 3 * k + std::size_t(axis))[place] =
          float(corners[k][axis]);
  parameters.set_color(place, color);
  parameters.trained(window_row::sigma)[place] = WindowParameters::log_of_sigma(config.first_sigma);
  parameters.trained(window_row::opacity)[place] = parameters.logit_of(config.first_opacity);
  parameters.activate(place);
}

}  // namespace tureen::trainer
