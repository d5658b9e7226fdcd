// Filters that are a product of a row filter and a column filter, in double precision: what SSIM
// and FLIP are made of.
#pragma once

#include <span>
#include <vector>

namespace tureen {

/// One channel of a picture, row by row from the top.
struct Plane {
  int width = 0;
  int height = 0;
  std::vector<double> values;

  Plane() = default;
  Plane(int w, int h) : width(w), height(h), values(std::size_t(w) * h) {}
  double& at(int x, int y) { return values[std::size_t(y) * width + x]; }
  double at(int x, int y) const { return values[std::size_t(y) * width + x]; }
};

/// What a filter sees past the edge of the picture.
enum class Border {
  zero,       // nothing: zeros
  replicate,  // the nearest pixel of the edge
  valid,      // it does not look: the result is smaller by the filter's length minus one
};

/// The weighted sum of each pixel's neighbours in its row, weights[i] for the one i - radius to
/// the right: a correlation, the weights are not mirrored. Their number is odd; under
/// Border::valid it is not greater than the width.
Plane filter_rows(const Plane& plane, std::span<const double> weights, Border border);

/// The same along columns, weights[i] for the pixel i - radius below.
Plane filter_columns(const Plane& plane, std::span<const double> weights, Border border);

/// exp(-x^2 / (2 sigma^2)) at x = -radius .. radius, not normalised.
std::vector<double> gaussian(double sigma, int radius);

}  // namespace tureen
