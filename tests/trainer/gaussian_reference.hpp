// Gaussians of the profile "3dgs" and discs of "2dgs", drawn in double precision, one pixel and one
// splat after the other, for numbers that carry a derivative.
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
#include "splatting/gaussians/gaussian_kernels.hpp"

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
inline double value_of(long double x) { return double(x); }
inline double root(double x) { return std::sqrt(x); }
inline long double root(long double x) { return std::sqrt(x); }
inline Dual root(Dual x) { return {std::sqrt(x.value), 0.5 / std::sqrt(x.value) * x.slope}; }
inline double power(double x) { return std::exp(x); }
inline long double power(long double x) { return std::exp(x); }
inline Dual power(Dual x) { return {std::exp(x.value), std::exp(x.value) * x.slope}; }

/// The branches that a drawing took, in order: one letter each. n: nearer than the profile allows;
/// c, per axis: the Jacobian's slope is limited; a: alpha below the smallest; m: alpha limited to
/// the largest; s: the pixel is closed; f: alpha is that of the filter on the screen; p: because
/// the ray does not meet the disc; '.': every other case.
using Branches = std::vector<char>;

/// The colour of a splat at this offset from the eye.
template <class Real>
std::array<Real, 3> reference_color(const std::array<Real, 3>& offset, const Real* coefficients,
                                    int degree) {
  const Real distance = root(offset[0] * offset[0] + offset[1] * offset[1] + offset[2] * offset[2]);
  const auto basis = harmonics::basis(
      glm::vec<3, Real>(offset[0] / distance, offset[1] / distance, offset[2] / distance));
  std::array<Real, 3> color;
  for (std::size_t c = 0; c < 3; ++c) {
    Real sum(0.5);
    for (int n = 0; n < harmonics::count(degree); ++n)
      sum = sum + basis[std::size_t(n)] * coefficients[3 * std::size_t(n) + c];
    color[c] = value_of(sum) > 0 ? sum : Real(0);
  }
  return color;
}

/// The columns of a rotation.
template <class Real>
std::array<std::array<Real, 3>, 3> reference_axes(Real i, Real j, Real k, Real w) {
  const Real length = root(i * i + j * j + k * k + w * w), two(2), one(1);
  i = i / length, j = j / length, k = k / length, w = w / length;
  return {{{one - two * (j * j + k * k), two * (i * j + w * k), two * (i * k - w * j)},
           {two * (i * j - w * k), one - two * (i * i + k * k), two * (j * k + w * i)},
           {two * (i * k + w * j), two * (j * k - w * i), one - two * (i * i + j * j)}}};
}

/// The values of a splat's parameters in a view.
template <class Real>
struct ReferenceValues {
  std::array<Real, 3> center;               // in view coordinates: x right, y down, z forward
  std::array<std::array<Real, 3>, 3> axes;  // of unit length, in view coordinates
  std::array<Real, 3> scales, color;
  Real opacity;
};

/// `p` are the trained values of a splat, in the order of gaussian_row.
template <class Real>
ReferenceValues<Real> reference_values(const Real* p, int degree, const Camera& camera) {
  namespace row = splatting::gaussian_row;
  ReferenceValues<Real> result;
  const glm::dvec3 eye = camera.eye();
  const glm::dmat3 turn(camera.view_from_world);
  const std::array<Real, 3> offset{p[row::x] - Real(eye.x), p[row::y] - Real(eye.y),
                                   p[row::z] - Real(eye.z)};
  // OpenGL's y points up and its z backwards.
  const auto in_view = [&](const std::array<Real, 3>& v) {
    std::array<Real, 3> turned;
    for (int axis = 0; axis < 3; ++axis) {
      const double sign = axis == 0 ? 1 : -1;
      turned[std::size_t(axis)] = Real(sign * turn[0][axis]) * v[0] +
                                  Real(sign * turn[1][axis]) * v[1] +
                                  Real(sign * turn[2][axis]) * v[2];
    }
    return turned;
  };
  result.center = in_view(offset);
  const auto axes = reference_axes(p[row::rotation_x], p[row::rotation_y], p[row::rotation_z],
                                   p[row::rotation_w]);
  for (std::size_t n = 0; n < 3; ++n) result.axes[n] = in_view(axes[n]);
  for (std::size_t n = 0; n < 3; ++n) result.scales[n] = power(p[row::scale_x + n]);
  result.opacity = Real(1) / (Real(1) + power(Real(0) - p[row::opacity]));
  result.color = reference_color(offset, p + row::harmonics, degree);
  return result;
}

/// A Gaussian, of the profile "3dgs".
template <class Real>
struct ReferenceGaussian {
  static constexpr const char* profile = "3dgs";
  Real x, y, inverse_xx, inverse_xy, inverse_yy, opacity;
  std::array<Real, 3> color;
  double depth;

  ReferenceGaussian(const ReferenceValues<Real>& values, const Camera& camera, Branches& branches)
      : opacity(values.opacity), color(values.color) {
    const auto& [center_x, center_y, z] = values.center;
    depth = value_of(z);
    x = Real(camera.fx) * center_x / z + Real(camera.cx);
    y = Real(camera.fy) * center_y / z + Real(camera.cy);
    const auto clamped = [&](Real slope, double low, double high) {
      branches.push_back(value_of(slope) < low || value_of(slope) > high ? 'c' : '.');
      return value_of(slope) < low ? Real(low) : value_of(slope) > high ? Real(high) : slope;
    };
    const double margin_x = ewa_margin * camera.width, margin_y = ewa_margin * camera.height;
    const Real along_x = clamped(center_x / z, (-margin_x - camera.cx) / camera.fx,
                                 (camera.width + margin_x - camera.cx) / camera.fx);
    const Real along_y = clamped(center_y / z, (-margin_y - camera.cy) / camera.fy,
                                 (camera.height + margin_y - camera.cy) / camera.fy);
    Real xx(dilation_variance), xy(0), yy(dilation_variance);
    for (std::size_t n = 0; n < 3; ++n) {
      const Real scale = values.scales[n] / z;
      const auto& axis = values.axes[n];
      const Real a = Real(camera.fx) * scale * (axis[0] - along_x * axis[2]);
      const Real b = Real(camera.fy) * scale * (axis[1] - along_y * axis[2]);
      xx = xx + a * a, xy = xy + a * b, yy = yy + b * b;
    }
    const Real determinant = xx * yy - xy * xy;
    inverse_xx = yy / determinant;
    inverse_xy = Real(0) - xy / determinant;
    inverse_yy = xx / determinant;
  }

  Real alpha(double pixel_x, double pixel_y, const Camera&, Branches&) const {
    const Real dx = Real(pixel_x) - x, dy = Real(pixel_y) - y;
    const Real q = inverse_xx * dx * dx + Real(2) * inverse_xy * dx * dy + inverse_yy * dy * dy;
    return opacity * power(Real(-0.5) * q);
  }
};

/// A disc, of the profile "2dgs".
template <class Real>
struct ReferenceDisc {
  static constexpr const char* profile = "2dgs";
  ReferenceValues<Real> values;
  std::array<Real, 3> color;
  double depth;

  ReferenceDisc(const ReferenceValues<Real>& in_view, const Camera&, Branches&)
      : values(in_view), color(in_view.color), depth(value_of(in_view.center[2])) {}

  /// Solves centre + u U + v V = t (ray), as two equations without t.
  Real alpha(double pixel_x, double pixel_y, const Camera& camera, Branches& branches) const {
    const Real ray_x((pixel_x - camera.cx) / camera.fx), ray_y((pixel_y - camera.cy) / camera.fy);
    const auto beside = [&](const std::array<Real, 3>& a, Real scale) {
      return std::array<Real, 2>{scale * (a[0] - a[2] * ray_x), scale * (a[1] - a[2] * ray_y)};
    };
    const auto a = beside(values.axes[0], values.scales[0]);
    const auto b = beside(values.axes[1], values.scales[1]);
    const auto c = beside(values.center, Real(1));
    const Real determinant = a[0] * b[1] - a[1] * b[0];
    const Real u = (c[1] * b[0] - c[0] * b[1]) / determinant;
    const Real v = (a[1] * c[0] - a[0] * c[1]) / determinant;
    const Real at = values.center[2] + u * values.scales[0] * values.axes[0][2] +
                    v * values.scales[1] * values.axes[1][2];
    Real q = u * u + v * v;
    const bool meets = std::isfinite(value_of(q)) && value_of(at) >= near;
    const Real dx =
        Real(pixel_x) - Real(camera.fx) * values.center[0] / values.center[2] - Real(camera.cx);
    const Real dy =
        Real(pixel_y) - Real(camera.fy) * values.center[1] / values.center[2] - Real(camera.cy);
    const Real on_screen = (dx * dx + dy * dy) / Real(screen_variance);
    const bool filtered = !meets || value_of(on_screen) < value_of(q);
    branches.push_back(!meets ? 'p' : filtered ? 'f' : '.');
    return values.opacity * power(Real(-0.5) * (filtered ? on_screen : q));
  }

  static constexpr double near = 1e-3;  // of TileRaster
};

/// The image over a background: red, green and blue planes, row 0 on top. `p` has `rows` values a
/// splat; `make(p, branches)` makes one of them.
template <class Real, class Make>
std::vector<Real> composited(const std::vector<Real>& p, std::size_t rows, const Make& make,
                             const Camera& camera, const std::array<float, 3>& background,
                             Branches* taken) {
  Branches branches;
  using Splat = decltype(make(p.data(), branches));
  const SplatProfile profile = *profile_named(Splat::profile);
  std::vector<Splat> splats;
  for (std::size_t first = 0; first < p.size(); first += rows) {
    const Splat splat = make(&p[first], branches);
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
    for (const Splat& splat : splats) {
      Real alpha = splat.alpha(x, y, camera, branches);
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

template <template <class> class Splat, class Real>
std::vector<Real> reference_image(const std::vector<Real>& p, std::size_t rows, int degree,
                                  const Camera& camera, const std::array<float, 3>& background,
                                  Branches* taken = nullptr) {
  const auto make = [&](const Real* values, Branches& branches) {
    return Splat<Real>(reference_values(values, degree, camera), camera, branches);
  };
  return composited(p, rows, make, camera, background, taken);
}

}  // namespace tureen::trainer::test
