#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <numeric>
#include <tuple>

#include "scene/edit/lint_findings.hpp"
#include "scene/spherical_harmonics.hpp"

namespace tureen {

namespace {

/// The extents of a splat. A window: its longest edge and the height over it.
struct SplatSize {
  double length = 0, width = 0;  // the largest, and the second largest
  bool has_zero = false;
};

struct MeasureSplat {
  std::size_t i;

  SplatSize operator()(const TriangleWindows& windows) const {
    const glm::vec3* corner = &windows.corners[3 * i];
    const glm::dvec3 a(corner[0]), b(corner[1]), c(corner[2]);
    const double longest =
        std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
    const double doubled_area = glm::length(glm::cross(b - a, c - a));
    // As for faces: far below any intended area.
    const bool is_degenerate = doubled_area <= 1e-12 * longest * longest;
    return {longest, longest > 0 ? doubled_area / longest : 0, is_degenerate};
  }
  SplatSize operator()(const Gaussians& gaussians) const {
    glm::dvec3 axes(gaussians.scales[i]);
    if (gaussians.flat) axes.z = std::min(axes.x, axes.y);  // only these two have an extent
    return of(axes);
  }
  SplatSize operator()(const NeuralDensities& densities) const {
    return of(glm::dvec3(densities.semi_axes[i]));
  }

  static SplatSize of(const glm::dvec3& axes) {
    std::array<double, 3> sorted{axes.x, axes.y, axes.z};
    std::sort(sorted.begin(), sorted.end());
    return {sorted[2], sorted[1], sorted[0] == 0};
  }
};

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
    if (values[i] > 10 * reach || std::visit(MeasureSplat{i}, splats.kernel).length > reach)
      count(finding, i);
}

/// Shape and place of a splat; of a neural density, also two of the network's parameters.
using SplatShape = std::array<float, 12>;

SplatShape shape_of(const Splats& splats, std::size_t i) {
  SplatShape shape{};
  const auto put = [&](std::size_t at, const auto& value) {
    std::memcpy(&shape[at], &value, sizeof value);
  };
  if (const auto* windows = std::get_if<TriangleWindows>(&splats.kernel)) {
    for (std::size_t corner = 0; corner < 3; ++corner)
      put(3 * corner, windows->corners[3 * i + corner]);
    put(9, windows->sigma[i]);
  } else if (const auto* gaussians = std::get_if<Gaussians>(&splats.kernel)) {
    put(0, gaussians->centers[i]);
    put(3, gaussians->scales[i]);
    put(6, gaussians->rotations[i]);
  } else {
    const auto& densities = std::get<NeuralDensities>(splats.kernel);
    put(0, densities.centers[i]);
    put(3, densities.semi_axes[i]);
    put(6, densities.rotations[i]);
    const float* network = &densities.networks[NeuralDensities::parameters * i];
    put(10, network[0]);
    put(11, network[NeuralDensities::parameters - 1]);
  }
  return shape;
}

void find_repeated(const Splats& splats, LintFinding& finding) {
  std::vector<std::uint32_t> order(count(splats));
  std::iota(order.begin(), order.end(), 0u);
  std::vector<SplatShape> shapes;
  for (const std::uint32_t i : order) shapes.push_back(shape_of(splats, i));
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::tie(shapes[a], a) < std::tie(shapes[b], b);
  });
  std::vector<std::uint32_t> repeated;
  for (std::size_t k = 1; k < order.size(); ++k)
    if (shapes[order[k]] == shapes[order[k - 1]]) repeated.push_back(order[k]);
  std::sort(repeated.begin(), repeated.end());
  for (const std::uint32_t i : repeated) count(finding, i);
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
    if (opacity && (*opacity)[i] < splats.profile.min_alpha) count(transparent, i);
    const SplatSize size = std::visit(MeasureSplat{i}, splats.kernel);
    if (size.has_zero)
      count(collapsed, i);
    else if (size.length > LintFinding::needle_aspect * size.width)
      count(needles, i);
  }
  find_outlying(splats, outlying);
  find_repeated(splats, repeated);
  if (number > 0) find_zero_harmonics(splats.color, zero);
  Lint result;
  add_counted(result, {&transparent, &collapsed, &needles, &outlying, &repeated, &zero});
  add_distance_from_origin(result, bounds(splats));
  return result;
}

}  // namespace tureen
