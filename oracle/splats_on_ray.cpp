#include "oracle/splats_on_ray.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat2x2.hpp>
#include <glm/matrix.hpp>

#include "oracle/splat_sample.hpp"
#include "scene/spherical_harmonics.hpp"

namespace tureen::oracle {

namespace {

/// Alpha is not limited.
struct OnRay {
  double alpha = 0, distance = std::numeric_limits<double>::infinity();
  glm::dvec3 weights{1, 0, 0};  // of the corners' colours
};

glm::dmat3 rotation_of(const glm::quat& rotation) {
  return glm::mat3_cast(glm::normalize(glm::dquat(rotation)));
}

double low_pass_of(const SplatProfile& profile) {
  switch (profile.low_pass) {
    case SplatProfile::LowPass::none:
      return 0;
    case SplatProfile::LowPass::screen:
      return screen_variance;
    default:
      return dilation_variance;
  }
}

OnRay on_plane(const Gaussians& discs, std::size_t i, const SplatProfile& profile,
               const LightRay& ray) {
  const glm::dmat3 axes = rotation_of(discs.rotations[i]);
  const glm::dvec3 to_center = glm::dvec3(discs.centers[i]) - ray.origin;
  OnRay result;
  double squared = std::numeric_limits<double>::infinity();
  const double distance = glm::dot(axes[2], to_center) / glm::dot(axes[2], ray.direction);
  if (distance > 0 && std::isfinite(distance)) {
    const glm::dvec3 offset = distance * ray.direction - to_center;
    const double u = glm::dot(offset, axes[0]) / double(discs.scales[i].x);
    const double v = glm::dot(offset, axes[1]) / double(discs.scales[i].y);
    squared = u * u + v * v;
    result.distance = distance;
  }
  const double before_center = glm::dot(to_center, ray.direction);
  if (profile.low_pass == SplatProfile::LowPass::screen && before_center > 0) {
    const double width = ray.pixel * (ray.path + before_center);
    const double off = glm::length(to_center - before_center * ray.direction) / width;
    if (off * off / screen_variance < squared) {
      squared = off * off / screen_variance;
      result.distance = before_center;
    }
  }
  result.alpha = double(discs.opacity[i]) * std::exp(-squared / 2);
  return result;
}

OnRay on_density(const Gaussians& gaussians, std::size_t i, const SplatProfile& profile,
                 const LightRay& ray) {
  // Coordinates across the ray (0, 1) and along it (2), from the origin.
  const glm::dvec3 side =
      std::abs(ray.direction.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 first = glm::normalize(glm::cross(ray.direction, side));
  const glm::dmat3 frame(first, glm::cross(ray.direction, first), ray.direction);
  const glm::dvec3 center = (glm::dvec3(gaussians.centers[i]) - ray.origin) * frame;
  glm::dvec3 scales(gaussians.scales[i]);
  if (gaussians.flat) scales.z = 0;
  glm::dmat3 shape = glm::transpose(frame) * rotation_of(gaussians.rotations[i]);
  for (int k = 0; k < 3; ++k) shape[k] *= scales[k];
  glm::dmat3 covariance = shape * glm::transpose(shape);
  const double before = covariance[0][0] * covariance[1][1] - covariance[0][1] * covariance[0][1];
  const double width = ray.pixel * (ray.path + std::max(center.z, 0.0));
  for (int k = 0; k < 3; ++k) covariance[k][k] += low_pass_of(profile) * width * width;
  const glm::dmat2 across(covariance);
  const double after = glm::determinant(across);
  if (!(after > 0)) return {};
  const glm::dvec2 offset(center);
  const glm::dvec2 solved = glm::inverse(across) * offset;
  OnRay result;
  result.alpha = double(gaussians.opacity[i]) * std::exp(-glm::dot(offset, solved) / 2);
  if (profile.low_pass == SplatProfile::LowPass::mip)
    result.alpha *= std::sqrt(std::max(before, 0.0) / after);
  // The mean along the ray, given the place across it.
  result.distance = center.z - glm::dot(glm::dvec2(covariance[2]), solved);
  return result;
}

OnRay on_ray(const Gaussians& gaussians, std::size_t i, const SplatProfile& profile,
             const LightRay& ray, double) {
  return profile.projection == SplatProfile::Projection::plane
             ? on_plane(gaussians, i, profile, ray)
             : on_density(gaussians, i, profile, ray);
}

OnRay on_ray(const TriangleWindows& windows, std::size_t i, const SplatProfile&,
             const LightRay& ray, double) {
  const glm::dvec3 corner[3] = {windows.corners[3 * i], windows.corners[3 * i + 1],
                                windows.corners[3 * i + 2]};
  const glm::dvec3 normal = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
  const double area = glm::length(normal);  // twice
  OnRay result;
  result.distance = glm::dot(normal, corner[0] - ray.origin) / glm::dot(normal, ray.direction);
  const glm::dvec3 point = ray.origin + result.distance * ray.direction;
  double nearest = std::numeric_limits<double>::infinity(), perimeter = 0;
  for (int k = 0; k < 3; ++k) {
    const glm::dvec3 &from = corner[(k + 1) % 3], edge = corner[(k + 2) % 3] - from;
    const double side = glm::dot(glm::cross(edge, point - from), normal) / area;
    result.weights[k] = side / area;
    nearest = std::min(nearest, side / glm::length(edge));
    perimeter += glm::length(edge);
  }
  const double rho = nearest / (area / perimeter);
  // False for NaN.
  if (rho > 0)
    result.alpha =
        double(windows.opacity[i]) * std::pow(std::min(rho, 1.0), double(windows.sigma[i]));
  return result;
}

OnRay on_ray(const NeuralDensities& densities, std::size_t i, const SplatProfile&,
             const LightRay& ray, double end) {
  const glm::dmat3 turned = glm::transpose(rotation_of(densities.rotations[i]));
  const glm::dvec3 axes(densities.semi_axes[i]), center(densities.centers[i]);
  const glm::dvec3 from = turned * (ray.origin - center) / axes;
  const glm::dvec3 along = turned * ray.direction / axes;
  // |from + t along| = 1.
  const double a = glm::dot(along, along), b = glm::dot(from, along);
  const glm::dvec3 nearest = from - b / a * along;
  const double left = 1 - glm::dot(nearest, nearest);
  if (!(left > 0)) return {};
  const double half_chord = std::sqrt(left / a);
  const double begin = std::max(-b / a - half_chord, 0.0);
  const double stop = std::min(-b / a + half_chord, end);
  if (!(begin < stop)) return {};
  const double largest = std::max({axes.x, axes.y, axes.z});
  const float* network = &densities.networks[NeuralDensities::parameters * i];
  constexpr int width = NeuralDensities::width;
  const double omega = densities.omega, length = (stop - begin) / largest;
  double integral = double(network[5 * width]) * length;
  for (int k = 0; k < width; ++k) {
    const glm::dvec3 w(network[3 * k], network[3 * k + 1], network[3 * k + 2]);
    const auto phase = [&](double t) {
      return omega * (glm::dot(w, (ray.origin + t * ray.direction - center) / largest) +
                      double(network[3 * width + k]));
    };
    const double turn = phase(stop) - phase(begin);
    // Of less than 1e-6, the cosine changes by as much.
    const double mean = std::abs(turn) > 1e-6
                            ? (std::sin(phase(stop)) - std::sin(phase(begin))) / turn
                            : std::cos(phase((begin + stop) / 2));
    integral += double(network[4 * width + k]) * mean * length;
  }
  return {-std::expm1(-std::max(integral, 0.0)), (begin + stop) / 2};
}

glm::dvec3 color_of(const SplatColor& color, std::size_t element, const glm::dvec3& from_eye) {
  const auto basis = harmonics::basis(glm::normalize(from_eye));
  const auto bands = std::size_t(harmonics::count(color.degree));
  glm::dvec3 sum(0.5);
  for (std::size_t k = 0; k < bands; ++k)
    sum += basis[k] * glm::dvec3(color.coefficients[element * bands + k]);
  return glm::max(sum, 0.0);
}

// Distances from the centre up to which a splat has alpha, without the low pass.
double reach_of(const Gaussians& gaussians, std::size_t i, float min_alpha) {
  const double squared = 2 * std::log(double(gaussians.opacity[i]) / double(min_alpha));
  glm::dvec3 scales(gaussians.scales[i]);
  if (gaussians.flat) scales.z = 0;
  return squared >= 0 ? std::sqrt(squared) * std::max({scales.x, scales.y, scales.z}) : -1.0;
}
double reach_of(const TriangleWindows& windows, std::size_t i, float) {
  const glm::vec3* corner = &windows.corners[3 * i];
  const glm::dvec3 middle =
      (glm::dvec3(corner[0]) + glm::dvec3(corner[1]) + glm::dvec3(corner[2])) / 3.0;
  double reach = 0;
  for (int k = 0; k < 3; ++k) reach = std::max(reach, glm::distance(middle, glm::dvec3(corner[k])));
  return reach;
}
double reach_of(const NeuralDensities& densities, std::size_t i, float) {
  const glm::vec3& axes = densities.semi_axes[i];
  return std::max({double(axes.x), double(axes.y), double(axes.z)});
}

}  // namespace

SplatsOnRays::SplatsOnRays(const Splats& splats) : splats_(splats) {
  const float min_alpha = splats.profile.min_alpha;
  for (std::size_t i = 0; i < count(splats); ++i)
    spheres_.push_back(
        {center(splats, i),
         std::visit([&](const auto& kernel) { return reach_of(kernel, i, min_alpha); },
                    splats.kernel)});
  widening_ = std::sqrt(2 * std::log(1 / double(min_alpha)) * low_pass_of(splats.profile));
}

void SplatsOnRays::find(const LightRay& ray, double end, std::vector<Found>& found) const {
  const double widening = widening_ * ray.pixel;
  for (std::size_t i = 0; i < spheres_.size(); ++i) {
    const Sphere& sphere = spheres_[i];
    const glm::dvec3 to_center = sphere.center - ray.origin;
    const double along = glm::dot(to_center, ray.direction);
    const double radius = sphere.radius + widening * (ray.path + std::max(along, 0.0));
    // 1e-9 for the rounding of this difference.
    const double squared = glm::dot(to_center, to_center);
    if (squared * (1 - 1e-9) - along * along > radius * radius || !(along > -radius) ||
        sphere.radius < 0)
      continue;
    const SplatOnRay splat = on_ray(i, ray, end);
    if (splat.alpha > 0) found.push_back({splat, i});
  }
}

SplatOnRay SplatsOnRays::on_ray(std::size_t i, const LightRay& ray, double end) const {
  const OnRay there = std::visit(
      [&](const auto& kernel) { return oracle::on_ray(kernel, i, splats_.profile, ray, end); },
      splats_.kernel);
  const double alpha = limited_alpha(there.alpha, splats_.profile);
  if (!(there.distance > 0 && there.distance < end) || alpha == 0) return {};
  SplatOnRay result{there.distance, alpha, glm::dvec3(0)};
  if (splats_.color.per_corner)
    for (int k = 0; k < 3; ++k)
      result.color +=
          there.weights[k] *
          color_of(splats_.color, 3 * i + std::size_t(k),
                   glm::dvec3(
                       std::get<TriangleWindows>(splats_.kernel).corners[3 * i + std::size_t(k)]) -
                       eye_of(ray));
  else
    result.color = color_of(splats_.color, i, center(splats_, i) - eye_of(ray));
  return result;
}

}  // namespace tureen::oracle
