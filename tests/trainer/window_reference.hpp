// Triangle windows of the profile "triangle-splatting" drawn in double precision, one pixel and one
// splat after the other, for numbers that carry a derivative. Windows in front of the eye have the
// paper's form (arXiv 2505.19175, section 3): corners are projected, and the inradius is twice the
// area over the perimeter. Only the others need homogeneous points (docs/numerics.md, W14).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/mat3x3.hpp>
#include <vector>

#include "scene/camera.hpp"
#include "scene/spherical_harmonics.hpp"
#include "scene/splats.hpp"
#include "splatting/windows/window_kernels.hpp"
#include "tests/trainer/gaussian_reference.hpp"

namespace tureen::trainer::test {

inline double logarithm(double x) { return std::log(x); }
inline Dual logarithm(Dual x) { return {std::log(x.value), x.slope / x.value}; }

/// The near plane of TileRaster.
inline constexpr double reference_near = 1e-3;

/// The values of a window that do not depend on the pixel.
template <class Real>
struct ReferenceWindow {
  std::array<std::array<Real, 2>, 3> corners;  // in pixels
  Real inradius, orientation, sigma, opacity;
  std::array<Real, 3> color;
  double depth, solidity;
  bool in_front;                              // all corners are beyond the near plane
  std::array<std::array<Real, 3>, 3> points;  // homogeneous, in pixels from the top left corner

  /// SolidRamp's rho_s, at most 1. Not positive: not drawn.
  Real rho(double x, double y) const {
    const Real soft = in_front ? soft_rho(x, y) : homogeneous_rho(x, y);
    if (solidity == 0) return soft;
    const Real ratio = Real(0.25) / inradius;
    const Real width = value_of(ratio) < 1 ? ratio : Real(1);
    const Real solid =
        soft / (Real(1 - solidity) + Real(2 * solidity) * width) + Real(0.5 * solidity);
    return value_of(solid) < 1 ? solid : Real(1);
  }

  /// The distance from the nearest edge over the inradius.
  Real soft_rho(double x, double y) const {
    Real nearest(1e300);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& a = corners[k];
      const auto& b = corners[(k + 1) % 3];
      const Real dx = b[0] - a[0], dy = b[1] - a[1];
      const Real distance = orientation * (dx * (Real(y) - a[1]) - dy * (Real(x) - a[0])) /
                            root(dx * dx + dy * dy) / inradius;
      if (value_of(distance) < value_of(nearest)) nearest = distance;
    }
    return nearest;
  }

  /// The edges' lines, their lengths in the image, and W and the determinant of W14.
  struct Homogeneous {
    std::array<std::array<Real, 3>, 3> lines;
    std::array<Real, 3> lengths;
    Real weight{0}, determinant{0};
  };

  Homogeneous homogeneous() const {
    Homogeneous result;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& a = points[(k + 1) % 3];
      const auto& b = points[(k + 2) % 3];
      auto& n = result.lines[k];
      n = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
      result.lengths[k] = root(n[0] * n[0] + n[1] * n[1]);
      result.weight = result.weight + points[k][2] * result.lengths[k];
      result.determinant = points[k][0] * n[0] + points[k][1] * n[1] + points[k][2] * n[2];
    }
    return result;
  }

  Real homogeneous_rho(double x, double y) const {
    const Real not_drawn(-1e30);
    const auto [lines, lengths, weight, determinant] = homogeneous();
    std::array<Real, 3> at;
    for (std::size_t k = 0; k < 3; ++k)
      at[k] = lines[k][0] * Real(x) + lines[k][1] * Real(y) + lines[k][2];
    if (!(value_of(weight) > 0)) return not_drawn;
    const double pixel_depth = value_of(determinant / (at[0] + at[1] + at[2]));
    if (!(pixel_depth >= reference_near)) return not_drawn;
    Real nearest(1);
    for (std::size_t k = 0; k < 3; ++k) {
      const Real distance = weight * at[k] / (determinant * lengths[k]);
      if (value_of(distance) < value_of(nearest)) nearest = distance;
    }
    return nearest;
  }
};

/// `p` are the trained values of a splat, in the order of window_row.
template <class Real>
ReferenceWindow<Real> reference_window(const Real* p, int degree, const Camera& camera,
                                       double solidity) {
  namespace row = splatting::window_row;
  ReferenceWindow<Real> result;
  const glm::dvec3 eye = camera.eye();
  const glm::dmat3 turn(camera.view_from_world);
  std::array<Real, 3> center{Real(0), Real(0), Real(0)};
  Real depth(0);
  result.in_front = true;
  for (std::size_t k = 0; k < 3; ++k) {
    std::array<Real, 3> offset, view;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      offset[axis] = p[row::corners + 3 * k + axis] - Real(eye[int(axis)]);
      center[axis] = center[axis] + offset[axis] / Real(3);
    }
    for (int axis = 0; axis < 3; ++axis) {
      // OpenGL's y points up and its z backwards.
      const double sign = axis == 0 ? 1 : -1;
      view[std::size_t(axis)] = Real(sign * turn[0][axis]) * offset[0] +
                                Real(sign * turn[1][axis]) * offset[1] +
                                Real(sign * turn[2][axis]) * offset[2];
    }
    result.corners[k] = {Real(camera.fx) * view[0] / view[2] + Real(camera.cx),
                         Real(camera.fy) * view[1] / view[2] + Real(camera.cy)};
    result.points[k] = {Real(camera.fx) * view[0] + Real(camera.cx) * view[2],
                        Real(camera.fy) * view[1] + Real(camera.cy) * view[2], view[2]};
    result.in_front = result.in_front && value_of(view[2]) > reference_near;
    depth = depth + view[2] / Real(3);
  }
  result.depth = value_of(depth);
  result.solidity = solidity;
  Real perimeter(0), doubled_area(0);
  for (std::size_t k = 0; k < 3; ++k) {
    const auto& a = result.corners[k];
    const auto& b = result.corners[(k + 1) % 3];
    const Real dx = b[0] - a[0], dy = b[1] - a[1];
    perimeter = perimeter + root(dx * dx + dy * dy);
    doubled_area = doubled_area + a[0] * b[1] - a[1] * b[0];
  }
  result.orientation = Real(value_of(doubled_area) < 0 ? -1 : 1);
  result.inradius = result.orientation * doubled_area / perimeter;
  if (!result.in_front) {
    const auto homogeneous = result.homogeneous();
    result.inradius = homogeneous.determinant / homogeneous.weight;
    if (value_of(result.inradius) < 0) result.inradius = Real(0) - result.inradius;
  }
  result.sigma = Real(0.01) + power(p[row::sigma]);
  result.opacity =
      Real(solidity) + Real(1 - solidity) / (Real(1) + power(Real(0) - p[row::opacity]));
  const Real distance = root(center[0] * center[0] + center[1] * center[1] + center[2] * center[2]);
  const auto basis = harmonics::basis(
      glm::vec<3, Real>(center[0] / distance, center[1] / distance, center[2] / distance));
  for (std::size_t c = 0; c < 3; ++c) {
    Real sum(0.5);
    for (int n = 0; n < harmonics::count(degree); ++n)
      sum = sum + basis[std::size_t(n)] * p[row::harmonics + 3 * std::size_t(n) + c];
    result.color[c] = value_of(sum) > 0 ? sum : Real(0);
  }
  return result;
}

/// The image over a background: red, green and blue planes, row 0 on top, and a fourth plane with
/// the sum over the channels of the variance that VarianceLoss describes. `p` has `rows` values a
/// splat.
template <class Real>
std::vector<Real> reference_window_image(const std::vector<Real>& p, std::size_t rows, int degree,
                                         const Camera& camera,
                                         const std::array<float, 3>& background,
                                         double solidity = 0) {
  const SplatProfile profile = *profile_named("triangle-splatting");
  std::vector<ReferenceWindow<Real>> windows;
  for (std::size_t first = 0; first < p.size(); first += rows) {
    const auto window = reference_window(&p[first], degree, camera, solidity);
    if (window.depth > double(profile.min_center_depth)) windows.push_back(window);
  }
  std::stable_sort(windows.begin(), windows.end(),
                   [](const auto& a, const auto& b) { return a.depth < b.depth; });
  const std::size_t pixels = std::size_t(camera.width) * std::size_t(camera.height);
  std::vector<Real> planes(4 * pixels);
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
    const double x = double(pixel % std::size_t(camera.width)) + 0.5;
    const double y = double(pixel / std::size_t(camera.width)) + 0.5;
    Real left(1);
    std::array<Real, 3> color{Real(0), Real(0), Real(0)};
    Real squares(0);
    for (const ReferenceWindow<Real>& window : windows) {
      const Real rho = window.rho(x, y);
      if (!(value_of(rho) > 0)) continue;
      Real alpha = window.opacity * power(window.sigma * logarithm(rho));
      if (value_of(alpha) < double(profile.min_alpha)) continue;
      if (value_of(alpha) > double(profile.max_alpha)) alpha = Real(double(profile.max_alpha));
      const Real after = left * (Real(1) - alpha);
      if (value_of(after) < double(profile.stop_transmittance)) break;
      for (std::size_t c = 0; c < 3; ++c) {
        color[c] = color[c] + alpha * left * window.color[c];
        squares = squares + alpha * left * window.color[c] * window.color[c];
      }
      left = after;
    }
    Real& variance = planes[3 * pixels + pixel];
    variance = squares;
    for (std::size_t c = 0; c < 3; ++c) {
      const Real behind(double(background[c]));
      const Real mean = color[c] + left * behind;
      planes[c * pixels + pixel] = mean;
      variance = variance + left * behind * behind - mean * mean;
    }
  }
  return planes;
}

}  // namespace tureen::trainer::test
