// Gaussians of the profile "3dgs" drawn in double precision, one pixel and one splat after the
// other, for numbers that carry a derivative.
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
#include "splatting/gaussian_kernels.hpp"

namespace tureen::trainer::test {

/// A number and its derivative by one variable.
struct Dual {
  double value = 0, slope = 0;
  Dual() = default;
  Dual(double v, double s = 0) : value(v), slope(s) {}  // NOLINT: numbers convert
  friend Dual operator+(Dual a, Dual b) { return {a.value + b.value, a.slope + b.slope}; }
  friend Dual operator-(Dual a, Dual b) { return {a.value - b.value, a.slope - b.slope}; }
  friend Dual operator*(Dual a, Dual b) {
    return {a.value * b.value, a.slope * b.value + a.value * b.slope};
  }
  friend Dual operator/(Dual a, Dual b) {
    return {a.value / b.value, (a.slope - a.value / b.value * b.slope) / b.value};
  }
};
inline double value_of(double x) { return x; }
inline double value_of(Dual x) { return x.value; }
inline double root(double x) { return std::sqrt(x); }
inline Dual root(Dual x) { return {std::sqrt(x.value), 0.5 / std::sqrt(x.value) * x.slope}; }
inline double power(double x) { return std::exp(x); }
inline Dual power(Dual x) { return {std::exp(x.value), std::exp(x.value) * x.slope}; }

/// The branches that a drawing took, in order: one letter each. n: nearer than the profile allows;
/// c, per axis: the Jacobian's slope is limited; a: alpha below the smallest; m: alpha limited to
/// the largest; s: the pixel is closed; '.': every other case.
using Branches = std::vector<char>;

/// The values of a splat that do not depend on the pixel.
template <class Real>
struct ReferenceSplat {
  Real x, y, inverse_xx, inverse_xy, inverse_yy, opacity;
  std::array<Real, 3> color;
  double depth;
};

/// `p` are the trained values of a splat, in the order of gaussian_row.
template <class Real>
ReferenceSplat<Real> reference_projection(const Real* p, int degree, const Camera& camera,
                                          Branches& branches) {
  namespace row = splatting::gaussian_row;
  ReferenceSplat<Real> result;
  const glm::dvec3 eye = camera.eye();
  const glm::dmat3 turn(camera.view_from_world);
  const std::array<Real, 3> offset{p[row::x] - Real(eye.x), p[row::y] - Real(eye.y),
                                   p[row::z] - Real(eye.z)};
  // OpenGL's y points up and its z backwards.
  const auto in_view = [&](const std::array<Real, 3>& v, int axis) {
    const double sign = axis == 0 ? 1 : -1;
    return Real(sign * turn[0][axis]) * v[0] + Real(sign * turn[1][axis]) * v[1] +
           Real(sign * turn[2][axis]) * v[2];
  };
  const Real x = in_view(offset, 0), y = in_view(offset, 1), z = in_view(offset, 2);
  result.depth = value_of(z);
  result.x = Real(camera.fx) * x / z + Real(camera.cx);
  result.y = Real(camera.fy) * y / z + Real(camera.cy);
  const auto clamped = [&](Real slope, double low, double high) {
    branches.push_back(value_of(slope) < low || value_of(slope) > high ? 'c' : '.');
    return value_of(slope) < low ? Real(low) : value_of(slope) > high ? Real(high) : slope;
  };
  const double margin_x = ewa_margin * camera.width, margin_y = ewa_margin * camera.height;
  const Real along_x = clamped(x / z, (-margin_x - camera.cx) / camera.fx,
                               (camera.width + margin_x - camera.cx) / camera.fx);
  const Real along_y = clamped(y / z, (-margin_y - camera.cy) / camera.fy,
                               (camera.height + margin_y - camera.cy) / camera.fy);
  Real i = p[row::rotation_x], j = p[row::rotation_y], k = p[row::rotation_z],
       w = p[row::rotation_w];
  const Real length = root(i * i + j * j + k * k + w * w);
  i = i / length, j = j / length, k = k / length, w = w / length;
  const Real two(2), one(1);
  const std::array<std::array<Real, 3>, 3> axes{
      {{one - two * (j * j + k * k), two * (i * j + w * k), two * (i * k - w * j)},
       {two * (i * j - w * k), one - two * (i * i + k * k), two * (j * k + w * i)},
       {two * (i * k + w * j), two * (j * k - w * i), one - two * (i * i + j * j)}}};
  Real xx(dilation_variance), xy(0), yy(dilation_variance);
  for (std::size_t n = 0; n < 3; ++n) {
    const Real scale = power(p[row::scale_x + n]) / z, depth = in_view(axes[n], 2);
    const Real a = Real(camera.fx) * scale * (in_view(axes[n], 0) - along_x * depth);
    const Real b = Real(camera.fy) * scale * (in_view(axes[n], 1) - along_y * depth);
    xx = xx + a * a, xy = xy + a * b, yy = yy + b * b;
  }
  const Real determinant = xx * yy - xy * xy;
  result.inverse_xx = yy / determinant;
  result.inverse_xy = Real(0) - xy / determinant;
  result.inverse_yy = xx / determinant;
  result.opacity = one / (one + power(Real(0) - p[row::opacity]));
  const Real distance = root(offset[0] * offset[0] + offset[1] * offset[1] + offset[2] * offset[2]);
  const auto basis = harmonics::basis(
      glm::vec<3, Real>(offset[0] / distance, offset[1] / distance, offset[2] / distance));
  for (std::size_t c = 0; c < 3; ++c) {
    Real sum(0.5);
    for (int n = 0; n < harmonics::count(degree); ++n)
      sum = sum + basis[std::size_t(n)] * p[row::harmonics + 3 * std::size_t(n) + c];
    result.color[c] = value_of(sum) > 0 ? sum : Real(0);
  }
  return result;
}

/// The image over a background: red, green and blue planes, row 0 on top. `p` has `rows` values a
/// splat.
template <class Real>
std::vector<Real> reference_image(const std::vector<Real>& p, std::size_t rows, int degree,
                                  const Camera& camera, const std::array<float, 3>& background,
                                  Branches* taken = nullptr) {
  const SplatProfile profile = *profile_named("3dgs");
  std::vector<ReferenceSplat<Real>> splats;
  Branches branches;
  for (std::size_t first = 0; first < p.size(); first += rows) {
    const ReferenceSplat<Real> splat = reference_projection(&p[first], degree, camera, branches);
    const bool near = !(splat.depth > double(profile.min_center_depth));
    branches.push_back(near ? 'n' : '.');
    if (!near) splats.push_back(splat);
  }
  std::stable_sort(splats.begin(), splats.end(),
                   [](const auto& a, const auto& b) { return a.depth < b.depth; });
  const std::size_t pixels = std::size_t(camera.width) * std::size_t(camera.height);
  std::vector<Real> planes(3 * pixels);
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
    const double x = double(pixel % std::size_t(camera.width)) + 0.5;
    const double y = double(pixel / std::size_t(camera.width)) + 0.5;
    Real left(1);
    std::array<Real, 3> color{Real(0), Real(0), Real(0)};
    for (const ReferenceSplat<Real>& splat : splats) {
      const Real dx = Real(x) - splat.x, dy = Real(y) - splat.y;
      const Real q = splat.inverse_xx * dx * dx + Real(2) * splat.inverse_xy * dx * dy +
                     splat.inverse_yy * dy * dy;
      Real alpha = splat.opacity * power(Real(-0.5) * q);
      branches.push_back('a');
      if (value_of(alpha) < double(profile.min_alpha)) continue;
      branches.back() = '.';
      if (value_of(alpha) > double(profile.max_alpha)) {
        alpha = Real(double(profile.max_alpha));
        branches.back() = 'm';
      }
      const Real after = left * (Real(1) - alpha);
      if (value_of(after) < double(profile.stop_transmittance)) {
        branches.back() = 's';
        break;
      }
      for (std::size_t c = 0; c < 3; ++c) color[c] = color[c] + alpha * left * splat.color[c];
      left = after;
    }
    for (std::size_t c = 0; c < 3; ++c)
      planes[c * pixels + pixel] = color[c] + left * Real(double(background[c]));
  }
  if (taken) *taken = std::move(branches);
  return planes;
}

}  // namespace tureen::trainer::test
