#include "trainer/splats/gaussian_densify.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "scene/edit/morton_order.hpp"

namespace tureen::trainer {

namespace row = splatting::gaussian_row;
namespace statistic = gaussian_statistic;

namespace {

constexpr std::size_t block = splatting::row_alignment;

bool is_finite(const GaussianParameters& parameters, std::size_t i) {
  for (std::size_t r = 0; r < parameters.rows(); ++r)
    if (!std::isfinite(parameters.trained(r)[i])) return false;
  return true;
}

/// `count` of these splats, without replacement, each with a probability in proportion to its
/// weight: the smallest of exponential variables with these rates (Efraimidis and Spirakis 2006).
std::vector<std::uint32_t> drawn(Random& random, std::span<const float> weights,
                                 std::span<const std::uint8_t> dead, std::size_t count) {
  std::vector<std::pair<double, std::uint32_t>> keys;
  for (std::uint32_t i = 0; i < weights.size(); ++i) {
    const double key = -std::log(1 - random.uniform()) / double(weights[i]);
    if (!dead[i] && weights[i] > 0) keys.emplace_back(key, i);
  }
  count = std::min(count, keys.size());
  std::nth_element(keys.begin(), keys.begin() + std::ptrdiff_t(count), keys.end());
  std::vector<std::uint32_t> result;
  for (std::size_t k = 0; k < count; ++k) result.push_back(keys[k].second);
  // In memory order: the result does not depend on the library's nth_element().
  std::sort(result.begin(), result.end());
  return result;
}

void reset_memory(GaussianMemory& memory, std::size_t rows, std::size_t i) {
  for (std::size_t line = 0; line < 2 * rows; ++line)
    memory.moments[2 * rows * (i / block) + line].values[i % block] = 0;
  for (std::size_t which = 0; which < statistic::count; ++which)
    memory.statistics.row(which)[i] = 0;
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
void enlarge(GaussianParameters& parameters, GaussianMemory& memory, std::size_t count) {
  const std::size_t old_count = parameters.count();
  GaussianParameters larger(count, parameters.degree);
  for (std::size_t r = 0; r < parameters.rows(); ++r) {
    std::copy_n(parameters.trained(r), old_count, larger.trained(r));
    std::copy_n(parameters.drawn.row(r), old_count, larger.drawn.row(r));
  }
  GaussianMemory more(larger);
  std::copy(memory.moments.begin(), memory.moments.end(), more.moments.begin());
  for (std::size_t which = 0; which < statistic::count; ++which)
    std::copy_n(memory.statistics.row(which), old_count, more.statistics.row(which));
  parameters = std::move(larger);
  memory = std::move(more);
}

}  // namespace

DensifyReport densify(const DensifyOptions& options, Random& random, GaussianParameters& parameters,
                      GaussianMemory& memory) {
  const std::size_t count = parameters.count();
  std::vector<std::uint8_t> dead(count);
  std::vector<std::uint32_t> places;
  for (std::uint32_t i = 0; i < count; ++i) {
    dead[i] = !(memory.statistics.row(statistic::evident)[i] > 0) ||
              !(parameters.drawn.row(row::opacity)[i] >= options.min_opacity) ||
              !is_finite(parameters, i);
    if (dead[i]) places.push_back(i);
  }
  DensifyReport report{.dead = places.size()};
  const std::size_t growth =
      std::max(std::size_t(options.growth * double(count)), std::min(count, options.min_growth));
  const std::size_t target = std::max(count, std::min(options.max_splats, count + growth));
  const std::vector<std::uint32_t> parents =
      drawn(random, {memory.statistics.row(statistic::motion), count}, dead,
            places.size() + (target - count));
  report.split = parents.size();
  if (parents.size() > places.size()) {
    const std::size_t added = parents.size() - places.size();
    enlarge(parameters, memory, count + added);
    for (std::size_t i = count; i < count + added; ++i) places.push_back(std::uint32_t(i));
  }
  for (std::size_t k = 0; k < parents.size(); ++k) {
    split(options, parameters, parents[k], places[k]);
    reset_memory(memory, parameters.rows(), parents[k]);
    reset_memory(memory, parameters.rows(), places[k]);
  }
  for (const std::size_t which : {statistic::motion, statistic::evident})
    std::fill_n(memory.statistics.row(which), parameters.count(), 0.0f);
  return report;
}

void sort_in_memory(GaussianParameters& parameters, GaussianMemory& memory) {
  const std::vector<std::uint32_t> order = morton_order(parameters.count(), [&](std::size_t i) {
    return glm::dvec3(parameters.trained(row::x)[i], parameters.trained(row::y)[i],
                      parameters.trained(row::z)[i]);
  });
  GaussianParameters sorted(parameters.count(), parameters.degree);
  GaussianMemory sorted_memory(sorted);
  const auto move = [&](const float* from, float* to) {
    for (std::size_t i = 0; i < order.size(); ++i) to[i] = from[order[i]];
  };
  const std::size_t rows = parameters.rows();
  for (std::size_t r = 0; r < rows; ++r) {
    move(parameters.trained(r), sorted.trained(r));
    move(parameters.drawn.row(r), sorted.drawn.row(r));
  }
  for (std::size_t which = 0; which < statistic::count; ++which)
    move(memory.statistics.row(which), sorted_memory.statistics.row(which));
  const auto moment = [rows](GaussianMemory& of, std::size_t line, std::size_t i) -> float& {
    return of.moments[2 * rows * (i / block) + line].values[i % block];
  };
  for (std::size_t i = 0; i < order.size(); ++i)
    for (std::size_t line = 0; line < 2 * rows; ++line)
      moment(sorted_memory, line, i) = moment(memory, line, order[i]);
  parameters = std::move(sorted);
  memory = std::move(sorted_memory);
}

}  // namespace tureen::trainer
