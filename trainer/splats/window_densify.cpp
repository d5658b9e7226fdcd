#include "trainer/splats/window_densify.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <utility>
#include <vector>

#include "trainer/splats/draw_by_weight.hpp"

namespace tureen::trainer {

namespace window_row = splatting::window_row;

namespace {

bool is_finite(const WindowParameters& parameters, std::size_t i) {
  for (std::size_t r = 0; r < parameters.rows(); ++r)
    if (!std::isfinite(parameters.trained(r)[i])) return false;
  return true;
}

float weight_of(WindowSampling sampling, const WindowParameters& parameters,
                const SplatMemory& memory, std::size_t i) {
  switch (sampling) {
    case WindowSampling::motion:
      return memory.statistics.row(splat_statistic::motion)[i];
    case WindowSampling::opacity:
      return parameters.drawn.row(window_row::opacity)[i];
    case WindowSampling::inverse_sigma:
      break;
  }
  return 1 / parameters.drawn.row(window_row::sigma)[i];
}

void divide(float overlap, WindowParameters& parameters, std::size_t parent, std::size_t place) {
  std::array<glm::vec3, 3> corners;
  const auto value = [&](std::size_t corner, int axis, std::size_t splat) -> float& {
    return parameters.trained(window_row::corners + 3 * corner + std::size_t(axis))[splat];
  };
  for (std::size_t k = 0; k < 3; ++k)
    for (int axis = 0; axis < 3; ++axis) corners[k][axis] = value(k, axis, parent);
  std::size_t from = 0;
  float longest = -1;
  for (std::size_t k = 0; k < 3; ++k) {
    const float length = glm::distance(corners[k], corners[(k + 1) % 3]);
    if (length > longest) longest = length, from = k;
  }
  const std::size_t to = (from + 1) % 3;
  for (std::size_t r = 0; r < parameters.rows(); ++r)
    parameters.trained(r)[place] = parameters.trained(r)[parent];
  const glm::vec3 end_of_first = glm::mix(corners[from], corners[to], 0.5f + overlap);
  const glm::vec3 begin_of_second = glm::mix(corners[from], corners[to], 0.5f - overlap);
  for (int axis = 0; axis < 3; ++axis) {
    value(to, axis, parent) = end_of_first[axis];
    value(from, axis, place) = begin_of_second[axis];
  }
  parameters.activate(parent);
  parameters.activate(place);
}

/// The new values are zeros.
void enlarge(WindowParameters& parameters, std::size_t count) {
  WindowParameters larger(count, parameters.degree);
  larger.min_opacity = parameters.min_opacity;
  for (std::size_t r = 0; r < parameters.rows(); ++r) {
    std::copy_n(parameters.trained(r), parameters.count(), larger.trained(r));
    std::copy_n(parameters.drawn.row(r), parameters.count(), larger.drawn.row(r));
  }
  parameters = std::move(larger);
}

}  // namespace

WindowDensifyReport densify_windows(const WindowDensifyOptions& options, Random& random,
                                    WindowParameters& parameters, SplatMemory& memory) {
  const std::size_t count = parameters.count();
  std::vector<float> weights(count);  // 0: dead
  std::vector<std::uint32_t> places;
  for (std::uint32_t i = 0; i < count; ++i) {
    const bool alive = memory.statistics.row(splat_statistic::evident)[i] > 0 &&
                       parameters.drawn.row(window_row::opacity)[i] >= options.min_opacity &&
                       is_finite(parameters, i);
    if (alive)
      weights[i] = weight_of(options.sampling, parameters, memory, i);
    else
      places.push_back(i);
  }
  WindowDensifyReport report{.dead = places.size()};
  const std::size_t target = std::max(
      count, std::min(options.max_splats, std::size_t(double(count) * (1 + options.growth))));
  const std::vector<std::uint32_t> parents =
      draw_by_weight(random, weights, places.size() + (target - count));
  report.split = parents.size();
  if (parents.size() > places.size()) {
    const std::size_t larger = count + parents.size() - places.size();
    enlarge(parameters, larger);
    memory.enlarge(larger);
    for (std::size_t i = count; i < larger; ++i) places.push_back(std::uint32_t(i));
  }
  for (std::size_t k = 0; k < parents.size(); ++k) {
    divide(options.overlap, parameters, parents[k], places[k]);
    memory.reset(parents[k]);
    memory.reset(places[k]);
  }
  for (const std::size_t which : {splat_statistic::motion, splat_statistic::evident})
    std::fill_n(memory.statistics.row(which), parameters.count(), 0.0f);
  return report;
}

}  // namespace tureen::trainer
