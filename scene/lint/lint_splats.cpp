#include <algorithm>
#include <glm/geometric.hpp>
#include <numeric>

#include "scene/lint/lint_findings.hpp"
#include "scene/near_limit.hpp"
#include "scene/spherical_harmonics.hpp"

namespace tureen {

namespace {

SplatSize size_of(const Splats& splats, std::size_t i) {
  return std::visit([i](const auto& kernel) { return size_of(kernel, i); }, splats.kernel);
}

std::size_t row_of(const Splats& splats, std::size_t i) {
  return splats.rows.empty() ? i : splats.rows[i];
}

/// The element at a fraction of the sorted values; 0 without values.
double quantile(std::vector<double> values, double fraction) {
  if (values.empty()) return 0;
  const auto at = values.begin() + std::ptrdiff_t(fraction * double(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

void find_outlying(const Splats& splats, LintFinding& finding) {
  const std::size_t number = count(splats);
  std::vector<double> values(number);
  glm::dvec3 middle;
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < number; ++i) values[i] = center(splats, i)[axis];
    middle[axis] = quantile(values, 0.5);
  }
  for (std::size_t i = 0; i < number; ++i) values[i] = glm::distance(center(splats, i), middle);
  const double reach = quantile(values, 0.9);
  // A few splats have no extent to compare with.
  if (!(reach > 0)) return;
  for (std::size_t i = 0; i < number; ++i)
    if (values[i] > 10 * reach || size_of(splats, i).length > reach)
      count(finding, row_of(splats, i));
}

/// Compares shape and place, everything but opacity and colour: below 0, 0 or above 0.
int compare(const SplatKernel& kernel, std::size_t a, std::size_t b) {
  int result = 0;
  for_each_column(kernel, [&](const auto& column) {
    if (result != 0 || column.role == ColumnRole::opacity) return;
    const std::span<const float> of_a = column.of_splat(a);
    const auto [x, y] = std::mismatch(of_a.begin(), of_a.end(), column.of_splat(b).begin());
    if (x != of_a.end()) result = *x < *y ? -1 : 1;
  });
  return result;
}

void find_repeated(const Splats& splats, LintFinding& finding) {
  std::vector<std::uint32_t> order(count(splats));
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const int compared = compare(splats.kernel, a, b);
    return compared != 0 ? compared < 0 : row_of(splats, a) < row_of(splats, b);
  });
  for (std::size_t k = 1; k < order.size(); ++k)
    if (compare(splats.kernel, order[k - 1], order[k]) == 0)
      count(finding, row_of(splats, order[k]));
}

void find_zero_harmonics(const SplatColor& color, LintFinding& finding) {
  const auto per_splat = std::size_t(harmonics::count(color.degree));
  const int used = degree_in_use(color);
  for (auto k = std::size_t(harmonics::count(used)); k < per_splat; ++k) count(finding, k);
}

}  // namespace

Lint lint(const Splats& splats) {
  const std::size_t number = count(splats);
  const std::vector<float>* opacity = opacity_of(splats.kernel);
  LintFinding transparent{.id = LintFinding::Id::transparent_splats, .of = number};
  LintFinding collapsed{.id = LintFinding::Id::collapsed_splats, .of = number};
  LintFinding needles{.id = LintFinding::Id::needle_splats, .of = number};
  LintFinding outlying{.id = LintFinding::Id::outlying_splats, .of = number};
  LintFinding repeated{.id = LintFinding::Id::duplicate_splats, .of = number};
  LintFinding zero{.id = LintFinding::Id::zero_harmonics,
                   .of = std::size_t(harmonics::count(splats.color.degree))};
  for (std::size_t i = 0; i < number; ++i) {
    const std::size_t row = row_of(splats, i);
    if (opacity && (*opacity)[i] < splats.profile.min_alpha) count(transparent, row);
    const SplatSize size = size_of(splats, i);
    if (size.has_zero)
      count(collapsed, row);
    else if (size.length > LintFinding::needle_aspect * size.width)
      count(needles, row);
  }
  find_outlying(splats, outlying);
  find_repeated(splats, repeated);
  if (number > 0) find_zero_harmonics(splats.color, zero);
  Lint result;
  add_counted(result, {&transparent, &collapsed, &needles, &outlying, &repeated});
  if (lower_near_limit(splats))
    result.findings.push_back(
        {.id = LintFinding::Id::large_near_limit, .count = number, .of = number});
  add_counted(result, {&zero});
  add_distance_from_origin(result, bounds(splats));
  return result;
}

}  // namespace tureen
