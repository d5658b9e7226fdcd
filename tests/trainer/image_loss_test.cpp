#include "trainer/common/cpu/image_loss.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "image/separable_filter.hpp"
#include "image/ssim.hpp"
#include "tests/support/random.hpp"
#include "trainer/common/kernels/image_loss.hpp"

namespace tureen::trainer {
namespace image_loss_test {

constexpr float nan_value = std::numeric_limits<float>::quiet_NaN();

// A rendered image, a photograph, and the loss between them.
template <class Real>
struct Pair {
  int width, height;
  std::vector<Real> rendered;
  std::vector<std::uint8_t> target;
  std::vector<std::uint8_t> ignored;
  std::vector<Real> gradient, pixel_loss;
  ImageLoss result;

  Pair(int w, int h)
      : width(w),
        height(h),
        rendered(3 * pixels()),
        target(3 * pixels()),
        gradient(3 * pixels(), Real(77)),  // to be overwritten
        pixel_loss(pixels(), Real(77)) {}

  std::size_t pixels() const { return std::size_t(width) * height; }

  const ImageLoss& run(int threads = 1, Real l1_weight = Real(0.8), Real ssim_weight = Real(0.2)) {
    ThreadPool pool(threads);
    ImageLossScratch<Real> scratch;
    const ImageLossView<Real> view = {.width = width,
                                      .height = height,
                                      .rendered = rendered,
                                      .target = target,
                                      .ignored = ignored,
                                      .l1_weight = l1_weight,
                                      .ssim_weight = ssim_weight,
                                      .gradient = gradient,
                                      .pixel_loss = pixel_loss};
    return result = image_loss(view, scratch, pool);
  }
};

// A smooth image with added noise, so that windows have all degrees of similarity. No value of
// `rendered` is closer to the photograph's than a fifth of a byte, because L1 has a kink there.
template <class Real>
Pair<Real> random_pair(std::uint64_t seed, int width, int height) {
  test::Random random(seed);
  Pair<Real> pair(width, height);
  for (std::size_t i = 0; i < pair.target.size(); ++i) {
    const double x = double(i % width) / width, y = double(i / width % height) / height;
    const double value = 0.5 + 0.3 * std::sin(7 * x + 3 * y) + random.uniform(-0.15, 0.15);
    pair.target[i] = std::uint8_t(255 * value);
    const double error = random.uniform(-0.2, 0.2) * y + 0.001;
    pair.rendered[i] = Real(pair.target[i] / 255.0 + std::copysign(std::abs(error) + 0.001, error));
  }
  return pair;
}

// The definition in double, without optimisation: every window, every pixel of it.
double reference_loss(const Pair<double>& pair, double l1_weight, double ssim_weight) {
  std::vector<double> weights = gaussian(1.5, 5);
  double all = 0, l1 = 0, ssim_sum = 0;
  for (const double w : weights) all += w;
  for (std::size_t i = 0; i < pair.rendered.size(); ++i)
    l1 += std::abs(pair.rendered[i] - pair.target[i] / 255.0);
  int windows = 0;
  for (int c = 0; c < 3; ++c)
    for (int y = 0; y + 11 <= pair.height; ++y)
      for (int x = 0; x + 11 <= pair.width; ++x, ++windows) {
        double a = 0, b = 0, aa = 0, bb = 0, ab = 0;
        for (int j = 0; j < 11; ++j)
          for (int i = 0; i < 11; ++i) {
            const std::size_t at = c * pair.pixels() + std::size_t(y + j) * pair.width + x + i;
            const double w = weights[i] * weights[j] / (all * all);
            const double p = pair.rendered[at], q = pair.target[at] / 255.0;
            a += w * p, b += w * q, aa += w * p * p, bb += w * q * q, ab += w * p * q;
          }
        const double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;
        ssim_sum += (2 * a * b + c1) * (2 * (ab - a * b) + c2) /
                    ((a * a + b * b + c1) * (aa - a * a + bb - b * b + c2));
      }
  return l1_weight * l1 / double(pair.rendered.size()) + ssim_weight * (1 - ssim_sum / windows) / 2;
}

// Central differences of fourth order. In an image of 19 x 17, some pixels are covered by windows
// at all offsets, others only at some.
std::vector<double> reference_gradient(Pair<double> pair, double l1_weight, double ssim_weight) {
  // The error of the formula is of the order of (h / 0.03)^4 = 1e-10; 0.03^2 is the smallest
  // variance that SSIM divides by. The error of rounding is 1e-16 / h = 1e-12 of a gradient of
  // about 1e-4.
  const double h = 1e-4;
  std::vector<double> gradient;
  for (double& value : pair.rendered) {
    const double at = value;
    const auto loss = [&](double step) {
      value = at + step * h;
      return reference_loss(pair, l1_weight, ssim_weight);
    };
    gradient.push_back((8 * (loss(1) - loss(-1)) - (loss(2) - loss(-2))) / (12 * h));
    value = at;
  }
  return gradient;
}

double largest(const std::vector<double>& values) {
  double result = 0;
  for (const double value : values) result = std::max(result, std::abs(value));
  return result;
}

TEST(ImageLoss, WeightsAreANormalisedGaussian) {
  const std::vector<double> weights = gaussian(1.5, 5);
  double all = 0;
  for (const double w : weights) all += w;
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(ssim_weight(i), weights[5 + i] / all, 1e-16) << i;
}

TEST(ImageLoss, ValueIsThatOfTheMetrics) {
  // Sizes near the window's, and near the height of a band of rows, 128.
  for (const auto& [width, height] :
       {std::pair{11, 11}, {12, 40}, {64, 48}, {37, 127}, {37, 129}, {29, 300}}) {
    const std::uint64_t seed = 1000 * std::uint64_t(width) + std::uint64_t(height);
    SCOPED_TRACE(std::to_string(width) + " x " + std::to_string(height) + ", seed " +
                 std::to_string(seed));
    auto pair = random_pair<float>(seed, width, height);
    ImageF a(width, height), b(width, height);
    double l1 = 0;
    for (int c = 0; c < 3; ++c)
      for (std::size_t i = 0; i < pair.pixels(); ++i) {
        float& value = pair.rendered[c * pair.pixels() + i];
        value = std::clamp(value, 0.0f, 1.0f);  // like the metric
        a.pixels[i][c] = value;
        b.pixels[i][c] = float(pair.target[c * pair.pixels() + i]) / 255.0f;
        l1 += std::abs(double(a.pixels[i][c]) - b.pixels[i][c]);
      }
    l1 /= double(3 * pair.pixels());
    const double similarity = ssim(a, b, SsimBorder::valid);
    pair.run();
    EXPECT_NEAR(pair.result.l1, l1, 1e-7);  // a rounding of 2^-25 per pixel
    EXPECT_NEAR(pair.result.ssim, similarity, 1e-6);
    EXPECT_NEAR(pair.result.loss, 0.8 * l1 + 0.1 * (1 - similarity), 1e-6);
    EXPECT_EQ(pair.result.non_finite, 0u);
  }
}

TEST(ImageLoss, GradientIsThatOfTheDefinition) {
  const std::uint64_t seed = 21;
  SCOPED_TRACE("seed " + std::to_string(seed));
  for (const auto& [l1_weight, ssim_weight] : {std::pair{0.8, 0.2}, {0.0, 1.0}, {1.0, 0.0}}) {
    auto pair = random_pair<double>(seed, 19, 17);
    pair.run(1, l1_weight, ssim_weight);
    EXPECT_NEAR(pair.result.loss, reference_loss(pair, l1_weight, ssim_weight), 1e-14);
    const std::vector<double> expected = reference_gradient(pair, l1_weight, ssim_weight);
    const double scale = largest(expected);
    for (std::size_t i = 0; i < expected.size(); ++i)
      // Where a derivative is close to 0, the differences still have the errors of the largest
      // ones.
      ASSERT_NEAR(pair.gradient[i], expected[i], 1e-6 * std::abs(expected[i]) + 1e-8 * scale) << i;
  }
}

TEST(ImageLoss, SinglePrecisionFollowsDouble) {
  const std::uint64_t seed = 22;
  SCOPED_TRACE("seed " + std::to_string(seed));
  auto exact = random_pair<double>(seed, 90, 300);
  auto fast = random_pair<float>(seed, 90, 300);
  std::copy(fast.rendered.begin(), fast.rendered.end(), exact.rendered.begin());
  exact.run();
  fast.run();
  const double scale = largest(exact.gradient);
  for (std::size_t i = 0; i < exact.gradient.size(); ++i)
    // A derivative has about two hundred additions and products. Roundings of 6e-8 of the larger
    // ones add up like a random walk, to 4e-7 here.
    ASSERT_NEAR(fast.gradient[i], exact.gradient[i], 2e-6 * scale) << i;
  for (std::size_t i = 0; i < exact.pixel_loss.size(); ++i)
    ASSERT_NEAR(fast.pixel_loss[i], exact.pixel_loss[i], 4e-7);  // sums of three below 1
}

TEST(ImageLoss, FlatBrightImagesKeepTheirDigits) {
  // White with weak noise: variances of 1e-6 next to means of 1. In single precision, a naive
  // subtraction of squares loses them, or makes them negative.
  const std::uint64_t seed = 23;
  SCOPED_TRACE("seed " + std::to_string(seed));
  test::Random random(seed);
  Pair<float> fast(40, 40);
  Pair<double> exact(40, 40);
  for (std::size_t i = 0; i < fast.target.size(); ++i) {
    exact.target[i] = fast.target[i] = std::uint8_t(254 + random.below(2));
    exact.rendered[i] = fast.rendered[i] = float(random.uniform(0.995, 1));
  }
  fast.run();
  exact.run();
  EXPECT_NEAR(fast.result.ssim, exact.result.ssim, 1e-6);
  const double scale = largest(exact.gradient);
  for (std::size_t i = 0; i < exact.gradient.size(); ++i)
    // Squares of 1 have errors of 1e-7, 1e-4 of the 0.03^2 that SSIM divides by; 2e-5 was measured.
    ASSERT_NEAR(fast.gradient[i], exact.gradient[i], 1e-4 * scale) << i;
}

TEST(ImageLoss, EqualImagesHaveNoLossAndNoGradient) {
  // All byte values, so that byte / 255 must be the same number in both.
  for (const bool flat : {false, true}) {
    Pair<float> pair(64, 64);
    for (std::size_t i = 0; i < pair.target.size(); ++i) {
      pair.target[i] = flat ? 255 : std::uint8_t(i * 37);
      pair.rendered[i] = float(pair.target[i]) / 255.0f;
    }
    pair.run();
    EXPECT_EQ(pair.result.l1, 0);
    EXPECT_EQ(pair.result.ssim, 1);
    EXPECT_EQ(pair.result.loss, 0);
    for (const float value : pair.gradient) ASSERT_EQ(value, 0);
    for (const float value : pair.pixel_loss) ASSERT_EQ(value, 0);
  }
}

TEST(ImageLoss, PixelLossIsTheSumOverChannels) {
  auto pair = random_pair<float>(24, 20, 30);
  pair.run();
  for (std::size_t i = 0; i < pair.pixels(); ++i) {
    double expected = 0;
    for (int c = 0; c < 3; ++c)
      expected += std::abs(pair.rendered[c * pair.pixels() + i] -
                           pair.target[c * pair.pixels() + i] / 255.0);
    ASSERT_NEAR(pair.pixel_loss[i], expected, 4e-7) << i;  // sums of three below 1
  }
}

TEST(ImageLoss, ImagesSmallerThanTheWindowHaveL1Alone) {
  for (const auto& [width, height] : {std::pair{10, 200}, {200, 10}, {1, 1}}) {
    auto pair = random_pair<float>(25, width, height);
    pair.run();
    EXPECT_EQ(pair.result.ssim, 1);
    EXPECT_GT(pair.result.l1, 0);
    EXPECT_DOUBLE_EQ(pair.result.loss, double(0.8f) * pair.result.l1);
    for (std::size_t i = 0; i < pair.gradient.size(); ++i) {
      const double sign = pair.rendered[i] > pair.target[i] / 255.0 ? 1 : -1;
      ASSERT_FLOAT_EQ(pair.gradient[i], float(sign * 0.8 / double(3 * pair.pixels()))) << i;
    }
  }
}

// An excluded pixel counts as equal to the photograph's, and has no gradient.
void expect_quarantined(const Pair<float>& damaged, Pair<float>& mended,
                        const std::vector<std::size_t>& pixels) {
  for (const std::size_t pixel : pixels)
    for (int c = 0; c < 3; ++c) {
      const std::size_t at = c * mended.pixels() + pixel;
      mended.rendered[at] = float(mended.target[at]) / 255.0f;
    }
  mended.run();
  EXPECT_EQ(damaged.result.loss, mended.result.loss);
  EXPECT_EQ(damaged.result.ssim, mended.result.ssim);
  EXPECT_EQ(damaged.pixel_loss, mended.pixel_loss);
  for (std::size_t i = 0; i < mended.gradient.size(); ++i) {
    const bool quarantined = std::count(pixels.begin(), pixels.end(), i % mended.pixels()) > 0;
    ASSERT_EQ(damaged.gradient[i], quarantined ? 0 : mended.gradient[i]) << i;
  }
}

TEST(ImageLoss, PixelsThatAreNotFiniteAreTakenForThePhotograph) {
  const std::uint64_t seed = 26;
  SCOPED_TRACE("seed " + std::to_string(seed));
  auto damaged = random_pair<float>(seed, 50, 150), mended = random_pair<float>(seed, 50, 150);
  // In one channel, in all, at a corner, and in the rows that two bands share.
  const std::vector<std::size_t> pixels = {0, 20 * 50 + 7, 74 * 50 + 20, 75 * 50 + 21,
                                           149 * 50 + 3};
  damaged.rendered[pixels[0]] = nan_value;
  for (int c = 0; c < 3; ++c) damaged.rendered[c * damaged.pixels() + pixels[1]] = nan_value;
  damaged.rendered[damaged.pixels() + pixels[2]] = std::numeric_limits<float>::infinity();
  damaged.rendered[pixels[3]] = -std::numeric_limits<float>::infinity();
  damaged.rendered[2 * damaged.pixels() + pixels[4]] = nan_value;
  damaged.run();
  EXPECT_EQ(damaged.result.non_finite, pixels.size());
  expect_quarantined(damaged, mended, pixels);
}

TEST(ImageLoss, PixelsThatTheCallerIgnoresDoNotCount) {
  const std::uint64_t seed = 27;
  SCOPED_TRACE("seed " + std::to_string(seed));
  auto masked = random_pair<float>(seed, 50, 150), mended = random_pair<float>(seed, 50, 150);
  const std::vector<std::size_t> pixels = {49, 74 * 50 + 20, 76 * 50, 149 * 50 + 49};
  masked.ignored.assign(masked.pixels(), 0);
  for (const std::size_t pixel : pixels) masked.ignored[pixel] = 1;
  masked.run();
  EXPECT_EQ(masked.result.non_finite, 0u);
  expect_quarantined(masked, mended, pixels);
}

TEST(ImageLoss, SameBitsWithAnyNumberOfThreads) {
  const std::uint64_t seed = 28;
  SCOPED_TRACE("seed " + std::to_string(seed));
  auto one = random_pair<float>(seed, 45, 400);
  one.rendered[1234] = nan_value;
  one.run(1);
  for (const int threads : {2, 3}) {
    auto more = random_pair<float>(seed, 45, 400);
    more.rendered[1234] = nan_value;
    more.run(threads);
    EXPECT_EQ(more.result.l1, one.result.l1);
    EXPECT_EQ(more.result.ssim, one.result.ssim);
    EXPECT_EQ(more.result.loss, one.result.loss);
    EXPECT_EQ(more.result.non_finite, 1u);
    EXPECT_EQ(more.gradient, one.gradient);
    EXPECT_EQ(more.pixel_loss, one.pixel_loss);
  }
}

TEST(ImageLoss, ViewsTogetherAreViewsAlone) {
  // Of different sizes, in memory that the others have used.
  auto a = random_pair<float>(29, 70, 140), b = random_pair<float>(30, 20, 15),
       c = random_pair<float>(31, 9, 9);
  std::vector<ImageLossView<float>> views;
  std::vector<std::vector<float>> gradients;
  for (Pair<float>* pair : {&a, &b, &c}) {
    pair->run();
    gradients.emplace_back(pair->rendered.size());
  }
  for (Pair<float>* pair : {&a, &b, &c})
    views.push_back({.width = pair->width,
                     .height = pair->height,
                     .rendered = pair->rendered,
                     .target = pair->target,
                     .gradient = gradients[views.size()]});
  std::vector<ImageLoss> results(3);
  ImageLossScratch<float> scratch;
  ThreadPool pool(2);
  for (int again = 0; again < 2; ++again) {
    image_losses<float>(views, results, scratch, pool);
    EXPECT_EQ(results[0].loss, a.result.loss);
    EXPECT_EQ(results[1].loss, b.result.loss);
    EXPECT_EQ(results[2].loss, c.result.loss);
    EXPECT_EQ(gradients[0], a.gradient);
    EXPECT_EQ(gradients[1], b.gradient);
    EXPECT_EQ(gradients[2], c.gradient);
  }
}

}  // namespace image_loss_test
}  // namespace tureen::trainer
