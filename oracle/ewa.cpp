#include "oracle/ewa.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "oracle/published_culls.hpp"

namespace tureen::oracle {

namespace {

/// One row of M, and the column of the low pass that belongs to it.
struct CovarianceRow {
  glm::dvec3 shape;
  glm::dvec2 filter;
};

double dot(const CovarianceRow& a, const CovarianceRow& b) {
  return glm::dot(a.shape, b.shape) + glm::dot(a.filter, b.filter);
}

double length(const CovarianceRow& a) { return std::sqrt(dot(a, a)); }

bool has_dilation(const SplatProfile& profile) {
  return profile.low_pass == SplatProfile::LowPass::dilation ||
         profile.low_pass == SplatProfile::LowPass::mip;
}

}  // namespace

std::optional<EwaInView> EwaInView::project(const Gaussians& gaussians, std::size_t i,
                                            const SplatProfile& profile, const SplatView& view) {
  EwaInView result;
  const glm::dvec3 center = view.point(gaussians.centers[i]);
  if (!(center.z > view.near())) return {};
  result.center_in_view_ = center;
  result.center_ = view.image(center);
  result.near_ = view.near();
  result.view_ = &view;
  result.profile_ = profile;

  glm::dvec3 scales(gaussians.scales[i]);
  if (gaussians.flat) scales.z = 0;
  const glm::dmat3 rotation = glm::mat3_cast(glm::normalize(glm::dquat(gaussians.rotations[i])));

  const Camera& camera = view.camera();
  const Camera& whole = view.whole();
  const glm::dvec2 size(whole.width, whole.height), middle(whole.cx, whole.cy);
  const glm::dvec2 focal(whole.fx, whole.fy);
  const glm::dvec2 low = (-ewa_margin * size - middle) / focal;
  const glm::dvec2 high = ((1 + ewa_margin) * size - middle) / focal;
  const double x = std::clamp(center.x / center.z, low.x, high.x);
  const double y = std::clamp(center.y / center.z, low.y, high.y);

  const double variance = has_dilation(profile) ? dilation_variance : 0.0;
  CovarianceRow a{{}, {std::sqrt(variance), 0}}, b{{}, {0, std::sqrt(variance)}};
  const double smallest = std::min({scales.x, scales.y, scales.z});
  for (int k = 0; k < 3; ++k) {
    const glm::dvec3 axis = view.direction(rotation[k]);
    result.axes_[k] = axis;
    result.sharpness_[k] = scales[k] > 0 ? smallest / scales[k] : 1.0;
    a.shape[k] = scales[k] * camera.fx * (axis.x - x * axis.z) / center.z;
    b.shape[k] = scales[k] * camera.fy * (axis.y - y * axis.z) / center.z;
  }

  // The LQ decomposition of the 2 x 5 matrix (M, sqrt(variance)) instead of a Cholesky
  // decomposition of the covariance: a needle of aspect A loses a factor A of precision, not A^2.
  const double xy = dot(a, b);
  result.l11_ = length(a);
  result.l21_ = xy / result.l11_;
  const double along = result.l21_ / result.l11_;
  result.l22_ = length({b.shape - along * a.shape, b.filter - along * a.filter});

  result.opacity_ = gaussians.opacity[i];
  if (profile.low_pass == SplatProfile::LowPass::mip) {
    // det(M M^T) = |a x b|^2 (Cauchy and Binet). The determinant after dilation is a sum of
    // positive terms, so nothing cancels.
    const double before = glm::length(glm::cross(a.shape, b.shape));
    const double trace = glm::dot(a.shape, a.shape) + glm::dot(b.shape, b.shape);
    result.opacity_ *= before / std::sqrt(before * before + variance * (trace + variance));
  }
  if (view.culls() == SplatCulls::published)
    result.tiles_ = published_tiles_of_gaussian(result.center_, dot(a, a), xy, dot(b, b));
  const double largest = 2 * std::log(result.opacity_ / double(profile.min_alpha));
  if (!(largest >= 0)) return {};
  result.box_ = box_around(result.center_, std::sqrt(largest) * glm::dvec2(length(a), length(b)));
  if (result.box_.empty() || !(result.l11_ > 0 && result.l22_ > 0)) return {};
  return result;
}

double EwaInView::squared_distance(const glm::dvec2& pixel) const {
  const glm::dvec2 d = pixel - center_;
  const double u = d.x / l11_, v = (d.y - l21_ * u) / l22_;
  return u * u + v * v;
}

double EwaInView::depth_of_largest_density(const glm::dvec3& ray) const {
  // Least squares for the depth t: the sum over the axes of ((t ray - center) . axis / scale)^2,
  // with all weights relative to the largest, which stays finite for scales of 0.
  double numerator = 0, denominator = 0;
  for (int k = 0; k < 3; ++k) {
    const double along = sharpness_[k] * glm::dot(ray, axes_[k]);
    numerator += along * sharpness_[k] * glm::dot(center_in_view_, axes_[k]);
    denominator += along * along;
  }
  const double depth = numerator / denominator;
  // A disc seen edge-on has no single largest density.
  return std::isfinite(depth) ? std::max(depth, near_) : center_in_view_.z;
}

SplatSample EwaInView::at(const glm::dvec2& pixel) const {
  if (tiles_ && !contains(*tiles_, pixel)) return {};
  const double alpha = limited_alpha(opacity_ * std::exp(-0.5 * squared_distance(pixel)), profile_);
  if (alpha == 0) return {};
  return {alpha, center_in_view_.z, depth_of_largest_density(view_->ray(pixel))};
}

}  // namespace tureen::oracle
