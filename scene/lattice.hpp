// The triangular lattice that textures one triangle (DiffSoup, arXiv 2603.27151, section 3).
//
// At level L the lattice has resolution n = 2^L and texels at (x, y), x, y >= 0, x + y <= n. Texel
// (x, y) lies at barycentrics b0 = x/n (weight of vertex 0), b1 = y/n (vertex 1), b2 = 1 - b0 - b1
// (vertex 2). Texels are stored diagonal by diagonal (texel_index). At level 0 their order is
// therefore vertex 2, vertex 0, vertex 1. shaders/lattice.glsl states the same rule in GLSL; a test
// compares the two.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace tureen::lattice {

inline constexpr int max_level = 7;

constexpr int resolution(int level) { return 1 << level; }

/// Texels of one triangle: 3, 6, 15, 45, 153, 561, 2145, 8385 for levels 0..7.
constexpr std::uint32_t texel_count(int level) {
  const std::uint32_t n = 1u << level;
  return (n + 1) * (n + 2) / 2;
}

/// Number of cells of one triangle. A cell is a square with four texels as its corners; on the last
/// diagonal it is half a square, with three. Cells are counted and indexed like the texels of a
/// lattice of resolution n - 1.
constexpr std::uint32_t cell_count(int level) {
  const std::uint32_t n = 1u << level;
  return n * (n + 1) / 2;
}

/// Linear index of the texel (x, y): texels are stored diagonal by diagonal, x + y = 0, 1, ..
constexpr std::uint32_t texel_index(int x, int y) {
  const int diagonal = x + y;
  return static_cast<std::uint32_t>(diagonal * (diagonal + 1) / 2 + y);
}

struct Coordinates {
  int x, y;
};

/// The inverse of texel_index. Exact for every level up to max_level.
inline Coordinates texel_coordinates(std::uint32_t index) {
  const double root = std::sqrt(8.0 * index + 1.0);
  const int diagonal = static_cast<int>((root - 1.0) / 2.0);
  const int y = static_cast<int>(index) - diagonal * (diagonal + 1) / 2;
  return {diagonal - y, y};
}

/// Calls visit(a, b, c) with the texels at the corners of each of the lattice's 4^level triangles.
template <class Visit>
void for_each_triangle(int level, const Visit& visit) {
  const int n = resolution(level);
  for (int y = 0; y < n; ++y)
    for (int x = 0; x + y < n; ++x) {
      visit(texel_index(x + 1, y), texel_index(x, y + 1), texel_index(x, y));
      if (x + y + 1 < n)
        visit(texel_index(x + 1, y), texel_index(x, y + 1), texel_index(x + 1, y + 1));
    }
}

/// The three texels around a point and their weights, which sum to 1 up to rounding.
template <class Real>
struct Footprint {
  std::array<std::uint32_t, 3> texels;
  std::array<Real, 3> weights;
};

/// Piecewise-linear interpolation at barycentrics (b0, b1), continuous across lattice cells. The
/// cell is clamped to the lattice. A point slightly outside extrapolates the border cell's plane,
/// so every index lies in [0, texel_count(level)). NaN gives a valid footprint with NaN weights.
/// The function is constexpr so that nvcc also compiles it for GPUs.
template <class Real>
constexpr Footprint<Real> footprint(int level, Real b0, Real b1) {
  const int n = resolution(level);
  Real p = b0 * static_cast<Real>(n);
  Real q = b1 * static_cast<Real>(n);
  // Clamped as floats before the cast, since casting a float outside int's range is undefined. The
  // argument order turns NaN into the lower bound. The cast rounds non-negative values down.
  const auto cell = [](Real value, int upper) {
    return static_cast<int>(std::min(std::max(Real(0), value), Real(upper)));
  };
  const int x = cell(p, n - 1);
  const int y = cell(q, n - 1 - x);
  p -= static_cast<Real>(x);
  q -= static_cast<Real>(y);
  if (p + q > Real(1)) {
    // On the last diagonal the fourth corner of the cell lies outside the lattice. A point there is
    // outside the triangle only by rounding; the border texel replaces that corner.
    const int corner_y = std::min(y + 1, n - (x + 1));
    const Real a = Real(1) - q, b = Real(1) - p;
    return {{texel_index(x + 1, y), texel_index(x, y + 1), texel_index(x + 1, corner_y)},
            {a, b, Real(1) - a - b}};
  }
  return {{texel_index(x + 1, y), texel_index(x, y + 1), texel_index(x, y)},
          {p, q, Real(1) - p - q}};
}

/// Interpolates three texels' values by differences, so that equal values are returned exactly. A
/// plain weighted sum would not do this, because rounding can make the weights sum to slightly less
/// than 1. A constant alpha of 1/2 would then fail the threshold at one point in twenty.
/// shaders/appearance_lattice.glsl does the same.
template <class Real, class Value>
constexpr Value interpolated(const std::array<Real, 3>& weights, const Value& a, const Value& b,
                             const Value& third) {
  return third + weights[0] * (a - third) + weights[1] * (b - third);
}

/// The same for one channel, whose values are indexed by texel.
template <class Real, class Value>
constexpr Value interpolated(const Footprint<Real>& at, const Value* values) {
  return interpolated(at.weights, values[at.texels[0]], values[at.texels[1]], values[at.texels[2]]);
}

}  // namespace tureen::lattice
