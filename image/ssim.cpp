#include "image/ssim.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "image/separable_filter.hpp"

namespace tureen {

namespace {

struct Window {
  std::vector<double> weights;  // of one axis, sum 1
  Border border;
  double variance_scale;  // factor on the window's variance: n / (n - 1) for the sample variance
};

Window window_of(SsimBorder border) {
  if (border == SsimBorder::uniform7)
    return {std::vector<double>(7, 1.0 / 7.0), Border::valid, 49.0 / 48.0};
  std::vector<double> weights = gaussian(1.5, 5);
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  for (double& weight : weights) weight /= sum;
  return {std::move(weights), border == SsimBorder::valid ? Border::valid : Border::zero, 1.0};
}

Plane blurred(const Plane& plane, const Window& window) {
  return filter_columns(filter_rows(plane, window.weights, window.border), window.weights,
                        window.border);
}

Plane channel(const ImageF& image, int c) {
  Plane plane(image.width, image.height);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const float value = image.pixels[i][c];
    plane.values[i] = value > 0.0f ? std::min(value, 1.0f) : 0.0f;  // NaN fails the comparison
  }
  return plane;
}

Plane product(const Plane& a, const Plane& b) {
  Plane result = a;
  for (std::size_t i = 0; i < result.values.size(); ++i) result.values[i] *= b.values[i];
  return result;
}

/// The mean over the windows that `counts` accepts, which gets the column and row of their middle.
template <class Counts>
double mean_similarity(const Plane& a, const Plane& b, const Window& window, const Counts& counts) {
  constexpr double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;
  const Plane mean_a = blurred(a, window), mean_b = blurred(b, window);
  const Plane aa = blurred(product(a, a), window), bb = blurred(product(b, b), window);
  const Plane ab = blurred(product(a, b), window);
  const int right = (a.width - mean_a.width) / 2, down = (a.height - mean_a.height) / 2;
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < mean_a.values.size(); ++i) {
    const int x = int(i % std::size_t(mean_a.width)), y = int(i / std::size_t(mean_a.width));
    if (!counts(x + right, y + down)) continue;
    ++count;
    const double m = mean_a.values[i], n = mean_b.values[i];
    // In flat areas E[x^2] - E[x]^2 cancels and may be negative.
    const double var_a = window.variance_scale * std::max(aa.values[i] - m * m, 0.0);
    const double var_b = window.variance_scale * std::max(bb.values[i] - n * n, 0.0);
    const double covariance = window.variance_scale * (ab.values[i] - m * n);
    sum += (2 * m * n + c1) * (2 * covariance + c2) / ((m * m + n * n + c1) * (var_a + var_b + c2));
  }
  return count > 0 ? sum / double(count) : 1;
}

}  // namespace

const char* name(SsimBorder border) {
  constexpr const char* names[] = {"zero_pad", "valid", "uniform7"};
  return names[std::size_t(border)];
}

double ssim(const ImageF& a, const ImageF& b, SsimBorder border,
            std::span<const std::uint8_t> ignored) {
  assert(a.width == b.width && a.height == b.height);
  const Window window = window_of(border);
  const int side = window.border == Border::valid ? int(window.weights.size()) : 1;
  if (a.width < side || a.height < side)
    throw UsageError("SSIM with border mode " + std::string(name(border)) +
                     " needs images of at least " + std::to_string(side) + " x " +
                     std::to_string(side) + " pixels; these have " + std::to_string(a.width) +
                     " x " + std::to_string(a.height));
  const auto counts = [&](int x, int y) {
    return ignored.empty() || !ignored[std::size_t(y) * std::size_t(a.width) + std::size_t(x)];
  };
  double sum = 0;
  for (int c = 0; c < 3; ++c) sum += mean_similarity(channel(a, c), channel(b, c), window, counts);
  return sum / 3;
}

}  // namespace tureen
