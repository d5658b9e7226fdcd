#include "image/separable_filter.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace tureen {

Plane filter_rows(const Plane& plane, std::span<const double> weights, Border border) {
  assert(weights.size() % 2 == 1);
  const int taps = int(weights.size()), radius = taps / 2;
  const int pad = border == Border::valid ? 0 : radius;
  assert(plane.width + 2 * pad >= taps);
  Plane result(plane.width + 2 * pad - (taps - 1), plane.height);
  std::vector<double> row(std::size_t(plane.width) + 2 * pad);
  for (int y = 0; y < plane.height; ++y) {
    const double* source = &plane.values[std::size_t(y) * plane.width];
    const bool zero = border == Border::zero;
    std::fill_n(row.begin(), pad, zero ? 0.0 : source[0]);
    std::copy_n(source, plane.width, row.begin() + pad);
    std::fill_n(row.end() - pad, pad, zero ? 0.0 : source[plane.width - 1]);
    double* out = &result.values[std::size_t(y) * result.width];
    // With taps in the outer loop, the inner loop has no dependency and vectorises.
    for (int tap = 0; tap < taps; ++tap)
      for (int x = 0; x < result.width; ++x) out[x] += weights[tap] * row[x + tap];
  }
  return result;
}

Plane filter_columns(const Plane& plane, std::span<const double> weights, Border border) {
  assert(weights.size() % 2 == 1);
  const int taps = int(weights.size()), radius = taps / 2;
  const int pad = border == Border::valid ? 0 : radius;
  assert(plane.height + 2 * pad >= taps);
  Plane result(plane.width, plane.height + 2 * pad - (taps - 1));
  for (int y = 0; y < result.height; ++y) {
    double* out = &result.values[std::size_t(y) * result.width];
    for (int tap = 0; tap < taps; ++tap) {
      int source_y = y + tap - pad;
      if (source_y < 0 || source_y >= plane.height) {
        if (border == Border::zero) continue;
        source_y = std::clamp(source_y, 0, plane.height - 1);
      }
      const double* source = &plane.values[std::size_t(source_y) * plane.width];
      for (int x = 0; x < plane.width; ++x) out[x] += weights[tap] * source[x];
    }
  }
  return result;
}

std::vector<double> gaussian(double sigma, int radius) {
  std::vector<double> weights;
  for (int x = -radius; x <= radius; ++x) weights.push_back(std::exp(-x * x / (2 * sigma * sigma)));
  return weights;
}

}  // namespace tureen
