#include "image/metrics.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <string>

#include "base/error.hpp"
#include "image/flip.hpp"

namespace tureen {

namespace {

/// NaN fails the comparison and becomes 0.
double clamped(float value) { return value > 0.0f ? std::min(double(value), 1.0) : 0.0; }

double difference(const glm::vec4& a, const glm::vec4& b, int channel) {
  return std::abs(clamped(a[channel]) - clamped(b[channel]));
}

double largest_difference(const glm::vec4& a, const glm::vec4& b) {
  return std::max({difference(a, b, 0), difference(a, b, 1), difference(a, b, 2)});
}

bool is_finite(const glm::vec4& p) {
  return std::isfinite(p.r) && std::isfinite(p.g) && std::isfinite(p.b) && std::isfinite(p.a);
}

void require_comparable(const ImageF& a, const ImageF& b) {
  const auto size = [](const ImageF& image) {
    return std::to_string(image.width) + " x " + std::to_string(image.height);
  };
  if (a.width != b.width || a.height != b.height)
    throw UsageError("the images differ in size: " + size(a) + " and " + size(b));
  if (a.pixels.empty()) throw UsageError("the images are empty");
}

double mean_flip(const ImageF& a, const ImageF& b, std::span<const std::uint8_t> ignored) {
  const FlipResult result = flip(a, b);
  if (ignored.empty()) return result.mean;
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < ignored.size(); ++i) {
    if (ignored[i]) continue;
    sum += double(result.map[i]);
    ++count;
  }
  return count > 0 ? sum / double(count) : 0;
}

/// The 99.9th percentile by nearest rank.
double percentile_999(std::vector<float> values) {
  const std::size_t rank = (values.size() * 999 + 999) / 1000;  // rounded up, at least 1
  const auto nth = values.begin() + std::ptrdiff_t(rank - 1);
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

}  // namespace

double psnr_from_mse(double mse) {
  constexpr double cap = 100.0;
  return mse > 0 ? std::min(-10.0 * std::log10(mse), cap) : cap;
}

double mean_squared_error(const ImageF& a, const ImageF& b) {
  require_comparable(a, b);
  double sum = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const double d = difference(a.pixels[i], b.pixels[i], c);
      sum += d * d;
    }
  return sum / (3.0 * double(a.pixels.size()));
}

Metrics compare(const ImageF& a, const ImageF& b, const MetricOptions& options) {
  require_comparable(a, b);
  const std::size_t pixels = a.pixels.size();
  Metrics result;
  std::size_t mismatched = 0, failing = 0;
  double sum = 0, sum_of_squares = 0;
  for (std::size_t i = 0; i < pixels; ++i) {
    const glm::vec4 &p = a.pixels[i], &q = b.pixels[i];
    for (int c = 0; c < 3; ++c) {
      const double d = difference(p, q, c);
      sum += d;
      sum_of_squares += d * d;
    }
    const double largest = largest_difference(p, q);
    result.max_abs = std::max(result.max_abs, largest);
    failing += largest > options.pixel_tolerance;
    mismatched += (p.a >= options.alpha_threshold) != (q.a >= options.alpha_threshold);
    result.non_finite += !is_finite(p) || !is_finite(q);
  }
  const auto skipped = std::count_if(options.ignored.begin(), options.ignored.end(),
                                     [](std::uint8_t each) { return each != 0; });
  const std::size_t counted = pixels - std::size_t(skipped);
  // Ignored pixels are equal: they add nothing to the sums.
  const double values = 3.0 * double(std::max<std::size_t>(counted, 1));
  result.mae = sum / values;
  result.mse = sum_of_squares / values;
  result.psnr_db = psnr_from_mse(result.mse);
  result.p999_abs = percentile_999(channel_differences(a, b));
  result.coverage_mismatch = double(mismatched) / double(pixels);
  result.failing_fraction = double(failing) / double(pixels);
  result.ssim = ssim(a, b, options.ssim_border, options.ignored);
  if (options.with_flip) result.flip = mean_flip(a, b, options.ignored);
  return result;
}

double equate_ignored(const ImageF& from, std::span<const std::uint8_t> ignored, ImageF& to) {
  assert(from.pixels.size() == to.pixels.size());
  assert(ignored.empty() || ignored.size() == to.pixels.size());
  std::size_t count = 0;
  for (std::size_t i = 0; i < ignored.size(); ++i)
    if (ignored[i]) {
      to.pixels[i] = from.pixels[i];
      ++count;
    }
  const std::size_t all = to.pixels.size();
  return count < all ? double(all) / double(all - count) : 1.0;
}

std::vector<float> channel_differences(const ImageF& a, const ImageF& b) {
  require_comparable(a, b);
  std::vector<float> differences;
  differences.reserve(3 * a.pixels.size());
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    for (int c = 0; c < 3; ++c)
      differences.push_back(float(difference(a.pixels[i], b.pixels[i], c)));
  return differences;
}

std::vector<float> difference_map(const ImageF& a, const ImageF& b) {
  require_comparable(a, b);
  std::vector<float> map(a.pixels.size());
  for (std::size_t i = 0; i < map.size(); ++i)
    map[i] = float(largest_difference(a.pixels[i], b.pixels[i]));
  return map;
}

ImageF composited(const ImageF& image, glm::vec3 background) {
  ImageF result = image;
  for (glm::vec4& p : result.pixels)
    p = glm::vec4(glm::mix(background, glm::vec3(p), glm::clamp(p.a, 0.0f, 1.0f)), p.a);
  return result;
}

}  // namespace tureen
