#include "oracle/window.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "oracle/published_culls.hpp"

namespace tureen::oracle {

std::optional<WindowInView> WindowInView::project(const TriangleWindows& windows, std::size_t i,
                                                  const SplatProfile& profile,
                                                  const SplatView& view) {
  const glm::vec3* corner = &windows.corners[3 * i];
  const glm::dvec3 corners[3] = {corner[0], corner[1], corner[2]};
  const Camera& camera = view.camera();
  const glm::dvec3 pixels(camera.fx, camera.fy, 1.0);

  WindowInView result;
  glm::dvec3 points[3];
  for (int k = 0; k < 3; ++k) points[k] = view.point(corners[k]);
  if (view.culls() == SplatCulls::published &&
      !is_published_window(view, {points[0], points[1], points[2]}))
    return {};
  // Edges are differences in layer coordinates, where those of float corners are exact: a short
  // edge of a distant triangle loses no digits.
  double w_sum = 0;
  std::array<double, 3> lengths;
  for (int k = 0; k < 3; ++k) {
    const int from = (k + 1) % 3, to = (k + 2) % 3;
    result.start_[k] = pixels * points[from];
    result.edge_[k] = pixels * view.direction(corners[to] - corners[from]);
    lengths[k] = glm::length(glm::dvec2(glm::cross(result.start_[k], result.edge_[k])));
    result.corner_depths_[k] = points[k].z;
    w_sum += points[k].z * lengths[k];
  }
  result.normal_ = glm::cross(result.edge_[0], result.edge_[1]);
  result.determinant_ = glm::dot(result.start_[0], result.normal_);
  for (int k = 0; k < 3; ++k) {
    result.scale_[k] = w_sum / lengths[k] / result.determinant_;
    // An edge that points at the eye has length 0: the triangle is seen edge-on.
    if (!std::isfinite(result.scale_[k])) return {};
  }
  if (!(w_sum > 0)) return {};

  result.sigma_ = windows.sigma[i];
  result.opacity_ = windows.opacity[i];
  result.near_ = view.near();
  result.principal_point_ = {camera.cx, camera.cy};
  result.profile_ = profile;
  result.box_ = box_around_triangle(view, points[0], points[1], points[2]);
  if (result.box_.empty() || limited_alpha(result.opacity_, profile) == 0) return {};
  return result;
}

double WindowInView::depth(const glm::dvec2& p) const {
  return determinant_ / glm::dot(normal_, glm::dvec3(p, 1.0));
}

double WindowInView::rho(const glm::dvec2& pixel) const {
  const glm::dvec2 p = pixel - principal_point_;
  if (!(depth(p) >= near_)) return 0;
  double nearest = 1;
  for (int k = 0; k < 3; ++k) nearest = std::min(nearest, scale_[k] * edge_product(k, p));
  return nearest > 0 ? nearest : 0;
}

double WindowInView::edge_product(int k, const glm::dvec2& p) const {
  // p . (start x edge), with both relative to p first: this cancels only near the edge's line.
  const glm::dvec2 a = glm::dvec2(start_[k]) - p * start_[k].z;
  const glm::dvec2 b = glm::dvec2(edge_[k]) - p * edge_[k].z;
  return a.x * b.y - a.y * b.x;
}

std::array<double, 3> WindowInView::corner_weights(const glm::dvec2& pixel) const {
  std::array<double, 3> weights;
  double sum = 0;
  for (int k = 0; k < 3; ++k) {
    // The common factor depth / D cancels.
    weights[k] = std::max(corner_depths_[k], 0.0) * edge_product(k, pixel - principal_point_);
    sum += weights[k];
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

SplatSample WindowInView::at(const glm::dvec2& pixel) const {
  const double distance = rho(pixel);
  if (!(distance > 0)) return {};
  const double z = depth(pixel - principal_point_);
  return {limited_alpha(opacity_ * std::pow(distance, sigma_), profile_), z, z};
}

}  // namespace tureen::oracle
