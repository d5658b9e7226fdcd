#include "tests/support/soup_splats.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "scene/edit/mean_color.hpp"
#include "scene/spherical_harmonics.hpp"

namespace tureen::test {

namespace {

/// The ellipse with the moments of a triangle.
struct Ellipse {
  glm::dvec3 center;
  glm::dquat rotation;       // x and y are its axes, z its normal
  glm::dvec2 deviations{0};  // along the axes
};

Ellipse ellipse_of(const glm::dvec3 (&corners)[3]) {
  Ellipse result;
  result.center = (corners[0] + corners[1] + corners[2]) / 3.0;
  const glm::dvec3 x = glm::normalize(corners[1] - corners[0]);
  const glm::dvec3 z = glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
  const glm::dvec3 y = glm::cross(z, x);
  double xx = 0, xy = 0, yy = 0;
  for (const glm::dvec3& corner : corners) {
    const glm::dvec2 at(glm::dot(corner - result.center, x), glm::dot(corner - result.center, y));
    xx += at.x * at.x / 12;
    xy += at.x * at.y / 12;
    yy += at.y * at.y / 12;
  }
  const double angle = 0.5 * std::atan2(2 * xy, xx - yy);
  const double middle = 0.5 * (xx + yy), difference = std::hypot(0.5 * (xx - yy), xy);
  result.deviations = {std::sqrt(middle + difference),
                       std::sqrt(std::max(middle - difference, 0.0))};
  const glm::dvec3 along = std::cos(angle) * x + std::sin(angle) * y;
  result.rotation = glm::normalize(glm::quat_cast(glm::dmat3(along, glm::cross(z, along), z)));
  return result;
}

struct AddTriangle {
  const glm::dvec3 (&corners)[3];

  void operator()(TriangleWindows& windows) const {
    const glm::dvec3 center = (corners[0] + corners[1] + corners[2]) / 3.0;
    for (const glm::dvec3& corner : corners)
      windows.corners.emplace_back(center + 2.0 * (corner - center));
    windows.sigma.push_back(1.0f);
    windows.opacity.push_back(0.95f);
  }
  void operator()(Gaussians& discs) const {
    const Ellipse ellipse = ellipse_of(corners);
    discs.centers.emplace_back(ellipse.center);
    discs.scales.emplace_back(glm::dvec3(1.2 * ellipse.deviations, 0.0));
    discs.rotations.emplace_back(ellipse.rotation);
    discs.opacity.push_back(0.95f);
  }
  void operator()(auto& /*kernel*/) const { assert(!"no such splats of triangles"); }
  void operator()(NeuralDensities& densities) const {
    const Ellipse ellipse = ellipse_of(corners);
    densities.centers.emplace_back(ellipse.center);
    const glm::dvec2 axes = 2.5 * ellipse.deviations;
    densities.semi_axes.emplace_back(glm::dvec3(axes, 0.3 * axes.x));
    densities.rotations.emplace_back(ellipse.rotation);
    // A constant density, and one neuron that swings about it.
    std::vector<float> network(NeuralDensities::parameters, 0.0f);
    network[0] = 0.3f;
    network[4 * NeuralDensities::width] = 4.0f;
    network.back() = 8.0f;
    densities.networks.insert(densities.networks.end(), network.begin(), network.end());
  }
};

SplatKernel empty_kernel(SplatKind::Kernel kind) {
  if (kind == SplatKind::Kernel::windows) return TriangleWindows{};
  Gaussians discs;
  discs.flat = true;
  if (kind == SplatKind::Kernel::flat) return discs;
  assert(kind == SplatKind::Kernel::neural);
  return NeuralDensities{};
}

}  // namespace

Splats splats_of(const TriangleSoup& soup, const SplatKind& kind) {
  Splats splats{.kernel = empty_kernel(kind.kernel), .profile = *profile_named(kind.profile)};
  const std::vector<glm::vec3> colors = mean_colors(soup);
  for (std::size_t face = 0; face < soup.triangles.size(); ++face) {
    glm::dvec3 corners[3];
    for (int k = 0; k < 3; ++k) corners[k] = soup.positions[soup.triangles[face][k]];
    if (!(glm::length(glm::cross(corners[1] - corners[0], corners[2] - corners[0])) > 0)) continue;
    std::visit(AddTriangle{corners}, splats.kernel);
    splats.color.coefficients.push_back((colors[face] - 0.5f) / float(harmonics::y00));
  }
  return splats;
}

}  // namespace tureen::test
