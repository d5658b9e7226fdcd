// Neural densities of the profile "splatnet" drawn in double precision, one pixel and one splat
// after the other, for numbers that carry a derivative. The chord is that of the quadratic equation
// along the ray from the eye, in layer coordinates, and the integral the difference of the
// antiderivative at its ends.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/mat3x3.hpp>
#include <vector>

#include "splatting/neural/neural_kernels.hpp"
#include "tests/trainer/gaussian_reference.hpp"

namespace tureen::trainer::test {

inline double sine(double x) { return std::sin(x); }
inline long double sine(long double x) { return std::sin(x); }
inline Dual sine(Dual x) { return {std::sin(x.value), std::cos(x.value) * x.slope}; }
inline double cosine(double x) { return std::cos(x); }
inline long double cosine(long double x) { return std::cos(x); }
inline Dual cosine(Dual x) { return {std::cos(x.value), -std::sin(x.value) * x.slope}; }

template <class Real>
Real product(const std::array<Real, 3>& a, const std::array<Real, 3>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Further letters of Branches. o: the ray misses the ellipsoid, or its part is nearer than the
/// near plane; k: the near plane cuts the chord; g: the optical depth is not positive; x, y, z: the
/// largest semi-axis.
template <class Real>
struct ReferenceDensity {
  static constexpr const char* profile = "splatnet";
  static constexpr double near = 1e-3;  // of TileRaster
  std::array<Real, 3> to_eye;           // from the centre
  std::array<std::array<Real, 3>, 3> axes;
  std::array<Real, 3> lengths, color;
  Real largest;
  const Real* p;
  double depth;

  /// `values`: trained ones, in the order of neural_row.
  ReferenceDensity(const Real* values, int degree, const Camera& camera, Branches& branches)
      : p(values) {
    namespace row = splatting::neural_row;
    const glm::dvec3 eye = camera.eye();
    std::array<Real, 3> offset;
    Real along(0);
    for (int k = 0; k < 3; ++k) {
      const auto at = std::size_t(k);
      offset[at] = p[row::center + at] - Real(eye[k]);
      to_eye[at] = Real(0) - offset[at];
      // OpenGL's z points backwards.
      along = along - Real(camera.view_from_world[k][2]) * offset[at];
    }
    depth = value_of(along);
    axes = reference_axes(p[row::rotation], p[row::rotation + 1], p[row::rotation + 2],
                          p[row::rotation + 3]);
    std::size_t which = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      lengths[k] = power(p[row::semi_axes + k]);
      if (value_of(lengths[k]) > value_of(lengths[which])) which = k;
    }
    branches.push_back("xyz"[which]);
    largest = lengths[which];
    color = reference_color(offset, p + row::harmonics, degree);
  }

  Real alpha(double x, double y, const Camera& camera, Branches& branches) const {
    const glm::dvec3 in_view((x - camera.cx) / camera.fx, -(y - camera.cy) / camera.fy, -1);
    const glm::dvec3 ray = glm::transpose(glm::dmat3(camera.view_from_world)) * in_view;
    const double length = std::sqrt(ray.x * ray.x + ray.y * ray.y + ray.z * ray.z);
    const std::array<Real, 3> d{Real(ray.x / length), Real(ray.y / length), Real(ray.z / length)};
    // From the point of the ray that is closest to the centre, so that the discriminant does not
    // cancel.
    const Real closest = Real(0) - product(to_eye, d);
    std::array<Real, 3> start;
    for (std::size_t k = 0; k < 3; ++k) start[k] = to_eye[k] + closest * d[k];
    const Real nearest = Real(near * length) - closest;
    Real a(0), b(0), c(-1);
    for (std::size_t k = 0; k < 3; ++k) {
      const Real from = product(axes[k], start) / lengths[k];
      const Real step = product(axes[k], d) / lengths[k];
      a = a + step * step, b = b + from * step, c = c + from * from;
    }
    const Real discriminant = b * b - a * c;
    branches.push_back('o');
    if (!(value_of(discriminant) > 0)) return Real(0);
    const Real half = root(discriminant) / a, middle = Real(0) - b / a;
    Real begin = middle - half;
    const Real end = middle + half;
    if (!(value_of(end - nearest) > 0)) return Real(0);
    branches.back() = '.';
    if (value_of(begin - nearest) < 0) {
      begin = nearest;
      branches.back() = 'k';
    }
    const Real depth_of_density = integral(start, d, begin, end);
    branches.push_back(value_of(depth_of_density) > 0 ? '.' : 'g');
    if (!(value_of(depth_of_density) > 0)) return Real(0);
    return Real(1) - power(Real(0) - depth_of_density);
  }

  /// Of the density along start + t d, over the largest semi-axis. `start`: from the centre.
  Real integral(const std::array<Real, 3>& start, const std::array<Real, 3>& d, Real begin,
                Real end) const {
    namespace row = splatting::neural_row;
    Real sum = p[row::offset] * (end - begin);
    for (std::size_t k = 0; k < splatting::neurons; ++k) {
      const Real* w = p + row::frequencies + 3 * k;
      const std::array<Real, 3> frequency{w[0], w[1], w[2]};
      const Real at_start = product(frequency, start) / largest + p[row::phases + k];
      const Real rate = product(frequency, d) / largest;
      const Real extent = rate * (end - begin);
      // Where the antiderivative would cancel: five points of Gauss and Legendre, whose error is
      // extent^10 / 6e11.
      Real of_neuron(0);
      if (std::abs(value_of(extent)) > 0.05) {
        of_neuron = (sine(at_start + rate * end) - sine(at_start + rate * begin)) / rate;
      } else {
        constexpr double places[] = {-0.906179845938664, -0.538469310105683, 0, 0.538469310105683,
                                     0.906179845938664};
        constexpr double weights[] = {0.236926885056189, 0.478628670499366, 0.568888888888889,
                                      0.478628670499366, 0.236926885056189};
        for (std::size_t n = 0; n < 5; ++n) {
          const Real t = Real(0.5) * (begin + end) + Real(0.5 * places[n]) * (end - begin);
          of_neuron =
              of_neuron + Real(0.5 * weights[n]) * (end - begin) * cosine(at_start + rate * t);
        }
      }
      sum = sum + p[row::amplitudes + k] * of_neuron;
    }
    return sum / largest;
  }
};

/// As reference_image().
template <class Real>
std::vector<Real> reference_density_image(const std::vector<Real>& p, std::size_t rows, int degree,
                                          const Camera& camera,
                                          const std::array<float, 3>& background,
                                          Branches* taken = nullptr) {
  const auto make = [&](const Real* values, Branches& branches) {
    return ReferenceDensity<Real>(values, degree, camera, branches);
  };
  return composited(p, rows, make, camera, background, taken);
}

}  // namespace tureen::trainer::test
