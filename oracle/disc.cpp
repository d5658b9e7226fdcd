#include "oracle/disc.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "oracle/published_culls.hpp"

namespace tureen::oracle {

std::optional<DiscInView> DiscInView::project(const Gaussians& gaussians, std::size_t i,
                                              const SplatProfile& profile, const SplatView& view) {
  DiscInView result;
  const glm::dmat3 rotation = glm::mat3_cast(glm::normalize(glm::dquat(gaussians.rotations[i])));
  result.center_ = view.point(gaussians.centers[i]);
  result.u_axis_ = view.direction(rotation[0] * double(gaussians.scales[i].x));
  result.v_axis_ = view.direction(rotation[1] * double(gaussians.scales[i].y));
  result.opacity_ = gaussians.opacity[i];
  result.view_ = &view;
  result.profile_ = profile;

  const double largest = 2 * std::log(result.opacity_ / double(profile.min_alpha));
  if (!(largest >= 0)) return {};
  const double radius = std::sqrt(largest);
  if (profile.low_pass == SplatProfile::LowPass::screen) {
    if (!(result.center_.z > view.near())) return {};
    result.center_image_ = view.image(result.center_);
    if (view.culls() == SplatCulls::published)
      result.tiles_ = published_tiles_of_disc(view, result.center_, result.u_axis_, result.v_axis_);
    result.box_ = box_around(result.center_image_, glm::dvec2(radius * std::sqrt(screen_variance)));
  }
  // The square around the disc, as two triangles.
  const glm::dvec3 u = radius * result.u_axis_, v = radius * result.v_axis_;
  const glm::dvec3 corners[4] = {result.center_ - u - v, result.center_ + u - v,
                                 result.center_ + u + v, result.center_ - u + v};
  result.box_.add(box_around_triangle(view, corners[0], corners[1], corners[2]));
  result.box_.add(box_around_triangle(view, corners[0], corners[2], corners[3]));
  if (result.box_.empty()) return {};
  return result;
}

SplatSample DiscInView::at(const glm::dvec2& pixel) const {
  if (tiles_ && !contains(*tiles_, pixel)) return {};
  // center + u u_axis + v v_axis = depth ray. The ray's z is 1, so subtracting z times the ray from
  // each vector leaves two equations in x and y.
  const glm::dvec3 ray = view_->ray(pixel);
  const glm::dvec2 c = glm::dvec2(center_) - center_.z * glm::dvec2(ray);
  const glm::dvec2 a = glm::dvec2(u_axis_) - u_axis_.z * glm::dvec2(ray);
  const glm::dvec2 b = glm::dvec2(v_axis_) - v_axis_.z * glm::dvec2(ray);
  const double determinant = a.x * b.y - a.y * b.x;
  const double u = (c.y * b.x - c.x * b.y) / determinant;
  const double v = (a.y * c.x - a.x * c.y) / determinant;
  double depth = center_.z + u * u_axis_.z + v * v_axis_.z;
  double q = u * u + v * v;
  const bool meets_plane = std::isfinite(q) && depth >= view_->near();
  if (profile_.low_pass == SplatProfile::LowPass::screen) {
    const glm::dvec2 d = pixel - center_image_;
    const double filtered = glm::dot(d, d) / screen_variance;
    if (!meets_plane || filtered < q) {
      q = filtered;
      depth = center_.z;
    }
  } else if (!meets_plane) {
    return {};
  }
  return {limited_alpha(opacity_ * std::exp(-0.5 * q), profile_), depth, depth};
}

}  // namespace tureen::oracle
