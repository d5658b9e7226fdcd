#include "trainer/splats/gaussian_densify.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "trainer/splats/draw_by_weight.hpp"

namespace tureen::trainer {

namespace row = splatting::gaussian_row;
namespace statistic = splat_statistic;

namespace {

bool is_finite(const GaussianParameters& parameters, std::size_t i) {
  for (std::size_t r = 0; r < parameters.rows(); ++r)
    if (!std::isfinite(parameters.trained(r)[i])) return false;
  return true;
}

void copy_splat(GaussianParameters& parameters, std::size_t from, std::size_t to) {
  for (std::size_t r = 0; r < parameters.rows(); ++r)
    parameters.trained(r)[to] = parameters.trained(r)[from];
}

/// Splits `parent` along its longest axis; its place becomes the first child's.
void split(const DensifyOptions& options, GaussianParameters& parameters, std::size_t parent,
           std::size_t place) {
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
  copy_splat(parameters, parent, place);
  for (int k = 0; k < 3; ++k) {
    parameters.trained(row::x + std::size_t(k))[parent] -= offset[k];
    parameters.trained(row::x + std::size_t(k))[place] += offset[k];
  }
  parameters.activate(parent);
  parameters.activate(place);
}

/// Values for more splats; the new ones are zeros.
void enlarge(GaussianParameters& parameters, SplatMemory& memory, std::size_t count) {
  const std::size_t old_count = parameters.count();
  GaussianParameters larger(count, parameters.degree);
  for (std::size_t r = 0; r < parameters.rows(); ++r) {
    std::copy_n(parameters.trained(r), old_count, larger.trained(r));
    std::copy_n(parameters.drawn.row(r), old_count, larger.drawn.row(r));
  }
  parameters = std::move(larger);
  memory.enlarge(count);
}

}  // namespace

DensifyReport densify(const DensifyOptions& options, Random& random, GaussianParameters& parameters,
                      SplatMemory& memory) {
  const std::size_t count = parameters.count();
  std::vector<float> weights(count);  // 0: dead
  std::vector<std::uint32_t> places;
  for (std::uint32_t i = 0; i < count; ++i) {
    const bool dead = !(memory.statistics.row(statistic::evident)[i] > 0) ||
                      !(parameters.drawn.row(row::opacity)[i] >= options.min_opacity) ||
                      !is_finite(parameters, i);
    if (dead)
      places.push_back(i);
    else
      weights[i] = memory.statistics.row(statistic::motion)[i];
  }
  DensifyReport report{.dead = places.size()};
  const std::size_t growth =
      std::max(std::size_t(options.growth * double(count)), std::min(count, options.min_growth));
  const std::size_t target = std::max(count, std::min(options.max_splats, count + growth));
  const std::vector<std::uint32_t> parents =
      draw_by_weight(random, weights, places.size() + (target - count));
  report.split = parents.size();
  if (parents.size() > places.size()) {
    const std::size_t added = parents.size() - places.size();
    enlarge(parameters, memory, count + added);
    for (std::size_t i = count; i < count + added; ++i) places.push_back(std::uint32_t(i));
  }
  for (std::size_t k = 0; k < parents.size(); ++k) {
    split(options, parameters, parents[k], places[k]);
    memory.reset(parents[k]);
    memory.reset(places[k]);
  }
  for (const std::size_t which : {statistic::motion, statistic::evident})
    std::fill_n(memory.statistics.row(which), parameters.count(), 0.0f);
  return report;
}

void sort_in_memory(const Region& region, GaussianParameters& parameters, SplatMemory& memory) {
  std::vector<glm::vec3> centers;
  for (std::size_t i = 0; i < parameters.count(); ++i)
    centers.emplace_back(parameters.trained(row::x)[i], parameters.trained(row::y)[i],
                         parameters.trained(row::z)[i]);
  const std::vector<std::uint32_t> order = morton_order(centers, region);
  parameters.reorder(order);
  memory.reorder(order);
}

}  // namespace tureen::trainer
