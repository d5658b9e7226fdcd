#include "oracle/neural_density.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

namespace tureen::oracle {

namespace {

double sinc(double x) {
  // Below 1/32 the first dropped term of the series is below 1e-16.
  if (std::abs(x) < 1.0 / 32) {
    const double xx = x * x;
    return 1 - xx / 6 * (1 - xx / 20 * (1 - xx / 42));
  }
  return std::sin(x) / x;
}

/// The box around the ellipsoid's image: that of its oriented box, or the whole image if a corner
/// of the box is nearer than the near plane.
ImageBox box_around_ellipsoid(const SplatView& view, const glm::dvec3& center,
                              const glm::dmat3& semi_axes) {
  const Camera& camera = view.camera();
  const ImageBox image{glm::dvec2(0.0), {camera.width, camera.height}};
  ImageBox box;
  bool is_behind = true;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 signs(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    const glm::dvec3 point = center + semi_axes * signs;
    if (point.z >= view.near()) {
      is_behind = false;
      box.add(box_around(view.image(point), glm::dvec2(0.0)));
    } else
      box = image;
  }
  return is_behind ? ImageBox{} : box;
}

}  // namespace

std::optional<NeuralDensityInView> NeuralDensityInView::project(const NeuralDensities& densities,
                                                                std::size_t i,
                                                                const SplatProfile& profile,
                                                                const SplatView& view) {
  NeuralDensityInView result;
  const glm::dvec3 center(densities.centers[i]), axes(densities.semi_axes[i]);
  const glm::dmat3 rotation = glm::mat3_cast(glm::normalize(glm::dquat(densities.rotations[i])));
  result.center_to_eye_ = view.eye() - center;
  glm::dmat3 semi_axes;
  for (int k = 0; k < 3; ++k) {
    result.sphere_from_layer_[k] = rotation[k] / axes[k];
    semi_axes[k] = view.direction(rotation[k] * axes[k]);
  }
  result.sphere_from_layer_ = glm::transpose(result.sphere_from_layer_);
  result.largest_axis_ = std::max({axes.x, axes.y, axes.z});

  const float* network = &densities.networks[NeuralDensities::parameters * i];
  const double omega = densities.omega;
  for (int k = 0; k < width; ++k) {
    result.frequencies_[k] =
        omega * glm::dvec3(network[3 * k], network[3 * k + 1], network[3 * k + 2]);
    result.phases_[k] = omega * double(network[3 * width + k]);
    result.amplitudes_[k] = network[4 * width + k];
  }
  result.offset_ = network[5 * width];
  result.view_ = &view;
  result.profile_ = profile;
  result.box_ = box_around_ellipsoid(view, view.point(center), semi_axes);
  if (result.box_.empty()) return {};
  return result;
}

double NeuralDensityInView::optical_depth(const glm::dvec2& pixel, double from, double to,
                                          double& middle_depth) const {
  const glm::dvec3 along = view_->direction_in_layer(view_->ray(pixel));
  const double length = glm::length(along);  // of the part of the ray with a depth of 1
  const glm::dvec3 d = along / length;

  // The chord, first relative to the point on the ray that is closest to the centre: from a distant
  // eye, the discriminant of the quadratic equation would cancel. Each step is repeated once to
  // remove its own rounding.
  glm::dvec3 closest = center_to_eye_ - glm::dot(center_to_eye_, d) * d;
  closest -= glm::dot(closest, d) * d;
  const double t_closest = glm::dot(closest - center_to_eye_, d);
  const glm::dvec3 whitened_d = sphere_from_layer_ * d;
  const double dd = glm::dot(whitened_d, whitened_d);
  glm::dvec3 whitened = sphere_from_layer_ * closest;
  double shift = -glm::dot(whitened, whitened_d) / dd;
  whitened += shift * whitened_d;
  const double correction = -glm::dot(whitened, whitened_d) / dd;
  whitened += correction * whitened_d;
  shift += correction;
  const double discriminant = 1 - glm::dot(whitened, whitened);
  if (!(discriminant > 0)) return 0;
  const double half = std::sqrt(discriminant / dd);
  const double t_middle = t_closest + shift;

  // Offsets from the chord's middle. Only the cut parts depend on t, which is large for a distant
  // eye.
  const double low = std::max(-half, from * length - t_middle);
  const double high = std::min(half, to * length - t_middle);
  if (!(low < high)) return 0;
  const double middle = (low + high) / 2, half_cut = (high - low) / 2;
  middle_depth = (t_middle + middle) / length;
  const glm::dvec3 u = (closest + (shift + middle) * d) / largest_axis_;
  double density = offset_;
  for (int k = 0; k < width; ++k) {
    const double b = glm::dot(frequencies_[k], d) / largest_axis_;
    const double phase = glm::dot(frequencies_[k], u) + phases_[k];
    density += amplitudes_[k] * sinc(b * half_cut) * std::cos(phase);
  }
  return 2 * half_cut / largest_axis_ * density;
}

SplatSample NeuralDensityInView::at(const glm::dvec2& pixel, double opaque_depth) const {
  double depth = 0;
  const double tau = optical_depth(pixel, view_->near(), opaque_depth, depth);
  const double alpha = limited_alpha(-std::expm1(-std::max(0.0, tau)), profile_);
  if (alpha == 0) return {};
  return {alpha, depth, depth};
}

}  // namespace tureen::oracle
