// Separable filters: the product of a row filter and a column filter, in double precision. SSIM and
// FLIP use them.
#pragma once

#include <span>
#include <vector>

namespace tureen {

/// One channel of an image, row by row from the top.
struct Plane {
  int width = 0;
  int height = 0;
  std::vector<double> values;

  Plane() = default;
  Plane(int w, int h) : width(w), height(h), values(std::size_t(w) * h) {}
  double& at(int x, int y) { return values[std::size_t(y) * width + x]; }
  double at(int x, int y) const { return values[std::size_t(y) * width + x]; }
};

/// The treatment of samples outside the image.
enum class Border {
  zero,       // zeros
  replicate,  // the nearest edge pixel
  valid,      // no samples outside: the result is smaller by the filter's length minus one
};

/// The weighted sum of each pixel's neighbours in its row, weights[i] for the pixel i - radius to
/// the right. This is a correlation: the weights are not mirrored. Their number is odd; under
/// Border::valid it is at most the width.
Plane filter_rows(const Plane& plane, std::span<const double> weights, Border border);

/// The same along columns, weights[i] for the pixel i - radius below.
Plane filter_columns(const Plane& plane, std::span<const double> weights, Border border);

/// exp(-x^2 / (2 sigma^2)) at x = -radius .. radius, not normalised.
std::vector<double> gaussian(double sigma, int radius);

}  // namespace tureen
