#include "image/metrics.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "base/error.hpp"
#include "image/flip.hpp"
#include "tests/support/errors.hpp"

namespace tureen {
namespace metrics_test {

using test::error_of;
using test::ErrorAt;

ImageF constant(int width, int height, glm::vec3 color) {
  return ImageF(width, height, glm::vec4(color, 1.0f));
}

/// An image with flat parts, steps and waves, in 8 bits. tests/image/metrics_reference.py computes
/// the same image.
ImageF pattern(int shift, double gain) {
  Image8 image(64, 48);
  const auto to_byte = [](double v) {
    return std::uint8_t(std::floor(std::min(std::max(v, 0.0), 1.0) * 255 + 0.5));
  };
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const int u = x + shift;
      const double checker = (u / 8 + y / 6) % 2 ? 0.15 : -0.15;
      image.at(x, y) =
          glm::u8vec4(to_byte(0.5 + 0.3 * std::sin(0.35 * u) * std::cos(0.22 * y) + checker),
                      to_byte(0.4 + 0.3 * std::cos(0.21 * u + 0.4 * y)),
                      to_byte(0.6 * gain + 0.3 * std::sin(0.8 * u - 0.1 * y)), 255);
    }
  return to_float(image);
}

/// The image of the border-mode measurements: 320 x 240, grey.
double measured_value(int x, int y) {
  const double steps = (x / 12 + y / 9) % 2 ? 0.15 : -0.15;
  const double value = 0.5 + 0.2 * std::sin(x * 0.07) * std::cos(y * 0.05) +
                       (x > 160 ? steps : 0.0) + (y > 120 ? 0.05 * std::sin(x * 1.3 + y * 0.9) : 0);
  return std::min(1.0, std::max(0.0, value));
}

ImageF measured_image(double shift) {
  ImageF image(320, 240);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const double next = measured_value(std::min(x + 1, image.width - 1), y);
      const double value = x + 1 < image.width ? (1 - shift) * measured_value(x, y) + shift * next
                                               : measured_value(x, y);
      image.at(x, y) = glm::vec4(glm::vec3(float(value)), 1.0f);
    }
  return image;
}

TEST(Metrics, EqualImagesArePerfect) {
  const ImageF image = pattern(0, 1);
  const Metrics m = compare(image, image);
  EXPECT_EQ(m.mae, 0);
  EXPECT_EQ(m.mse, 0);
  EXPECT_EQ(m.psnr_db, 100);
  EXPECT_NEAR(m.ssim, 1, 1e-12);
  EXPECT_EQ(m.flip, 0);
  EXPECT_EQ(m.max_abs, 0);
  EXPECT_EQ(m.p999_abs, 0);
  EXPECT_EQ(m.coverage_mismatch, 0);
  EXPECT_EQ(m.failing_fraction, 0);
}

TEST(Metrics, ConstantImagesGiveTheClosedForms) {
  const Metrics m =
      compare(constant(20, 12, {0.5f, 0.25f, 1.0f}), constant(20, 12, {0.25f, 0.25f, 0.5f}));
  EXPECT_DOUBLE_EQ(m.mae, (0.25 + 0 + 0.5) / 3);
  EXPECT_DOUBLE_EQ(m.mse, (0.0625 + 0 + 0.25) / 3);
  EXPECT_DOUBLE_EQ(m.psnr_db, -10 * std::log10(0.3125 / 3));
  EXPECT_DOUBLE_EQ(m.max_abs, 0.5);
  EXPECT_DOUBLE_EQ(m.failing_fraction, 1);
}

TEST(Metrics, AnUnpaddedSsimOfConstantImagesIsTheLuminanceTerm) {
  const double c1 = 1e-4, a = 0.5, b = 0.25;
  const double expected = (2 * a * b + c1) / (a * a + b * b + c1);
  const ImageF x = constant(20, 20, glm::vec3(0.5f)), y = constant(20, 20, glm::vec3(0.25f));
  // Flat images have no variance. Any remainder of a cancellation would change the result.
  EXPECT_NEAR(ssim(x, y, SsimBorder::valid), expected, 1e-12);
  EXPECT_NEAR(ssim(x, y, SsimBorder::uniform7), expected, 1e-12);
}

TEST(Metrics, PsnrIsTenDecibelsADecade) {
  EXPECT_DOUBLE_EQ(psnr_from_mse(1e-3), 30);
  EXPECT_DOUBLE_EQ(psnr_from_mse(1), 0);
  EXPECT_EQ(psnr_from_mse(0), 100);
  EXPECT_EQ(psnr_from_mse(1e-12), 100);
}

TEST(Metrics, TheNumberBordersTookInTheMeasurements) {
  struct Case {
    double shift, psnr_db, zero_pad, valid, uniform7;
  };
  for (const Case& c :
       {Case{1.0, 23.273, 0.7448, 0.7327, 0.7528}, Case{0.5, 29.294, 0.9273, 0.9237, 0.9265}}) {
    const ImageF a = measured_image(0), b = measured_image(c.shift);
    // Half a unit of the last recorded digit.
    EXPECT_NEAR(psnr_from_mse(mean_squared_error(a, b)), c.psnr_db, 0.0006);
    EXPECT_NEAR(ssim(a, b, SsimBorder::zero_pad), c.zero_pad, 0.00006);
    EXPECT_NEAR(ssim(a, b, SsimBorder::valid), c.valid, 0.00006);
    EXPECT_NEAR(ssim(a, b, SsimBorder::uniform7), c.uniform7, 0.00006);
  }
}

// The numbers are by scikit-image 0.19 (valid, uniform7) and by full two-dimensional kernels in
// numpy and scipy (zero_pad, FLIP): tests/image/metrics_reference.py prints them.
TEST(Metrics, AgreeWithIndependentImplementations) {
  const ImageF a = pattern(0, 1.0), b = pattern(1, 0.9);
  const Metrics m = compare(a, b);
  // Both sides compute in double from the same floats.
  EXPECT_NEAR(m.mae, 0.0902016107259745, 1e-12);
  EXPECT_NEAR(m.mse, 0.01575592445791689, 1e-12);
  EXPECT_NEAR(m.max_abs, 0.40000002086162567, 1e-12);
  EXPECT_NEAR(m.ssim, 0.8195426236490949, 1e-9);
  EXPECT_NEAR(ssim(a, b, SsimBorder::valid), 0.7951488648593149, 1e-9);
  EXPECT_NEAR(ssim(a, b, SsimBorder::uniform7), 0.8139546173367346, 1e-9);
  EXPECT_NEAR(m.flip, 0.32514929469164516, 1e-9);
  FlipOptions coarse;
  coarse.pixels_per_degree = 30;
  EXPECT_NEAR(flip(a, b, coarse).mean, 0.3898534396947178, 1e-9);
  const FlipResult result = flip(a, b);
  EXPECT_NEAR(result.map[0], 0.36636571078185737, 1e-6);  // the map is float
  EXPECT_NEAR(result.map[10 * 64 + 20], 0.4220687217600429, 1e-6);
  EXPECT_NEAR(result.map[47 * 64 + 63], 0.45113496224308575, 1e-6);
}

TEST(Flip, ConstantImagesHaveNoFeaturesAndAClosedForm) {
  const glm::vec3 black(0), white(1), green(0, 1, 0), blue(0, 0, 1);
  // Black and white differ by 100 units of lightness. Green and blue have the largest difference of
  // all colours.
  const double largest = 41.276570439672035, knee = 0.4 * largest;
  const double expected = 0.95 + 0.05 * (std::pow(100.0, 0.7) - knee) / (largest - knee);
  EXPECT_NEAR(flip(constant(30, 20, black), constant(30, 20, white)).mean, expected, 1e-9);
  EXPECT_NEAR(flip(constant(30, 20, green), constant(30, 20, blue)).mean, 1.0, 1e-9);
  EXPECT_NEAR(flip(constant(1, 1, glm::vec3(0.5f)), constant(1, 1, {0.6f, 0.5f, 0.5f})).mean,
              0.24959747790631315, 1e-6);  // 0.6 is a float here and a double there
}

TEST(Flip, IsSymmetricBoundedAndZeroOnlyWithoutDifference) {
  const unsigned seed = 7;
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(0, 1);
  ImageF a(37, 23), b(37, 23);
  for (ImageF* image : {&a, &b})
    for (glm::vec4& p : image->pixels) p = {uniform(random), uniform(random), uniform(random), 1};
  EXPECT_EQ(flip(a, a).mean, 0);
  EXPECT_EQ(flip(a, a).map, std::vector<float>(a.pixels.size(), 0.0f));
  const FlipResult forward = flip(a, b), backward = flip(b, a);
  EXPECT_DOUBLE_EQ(forward.mean, backward.mean);
  EXPECT_EQ(forward.map, backward.map);
  for (const float error : forward.map) {
    EXPECT_GT(error, 0);
    EXPECT_LE(error, 1);
  }
}

TEST(Flip, SeesAPointOfContrastMoreThanTheSameColourSpreadOut) {
  ImageF flat = constant(61, 61, glm::vec3(0.5f)), dot = flat, veil = flat;
  dot.at(30, 30) = glm::vec4(1, 1, 1, 1);
  for (glm::vec4& p : veil.pixels) p += glm::vec4(glm::vec3(0.5f / (61 * 61)), 0);
  EXPECT_GT(flip(flat, dot).map[30 * 61 + 30], 10 * flip(flat, veil).map[30 * 61 + 30]);
}

TEST(Metrics, CountCoverageAndFailuresByThePixel) {
  ImageF a = constant(20, 10, glm::vec3(0.5f)), b = a;
  b.at(3, 4).a = 0.49f;                         // no hit
  a.at(5, 5).a = b.at(5, 5).a = 0.2f;           // neither hits
  b.at(0, 0).r += 1.0f / 255;                   // rounding, does not fail
  b.at(1, 0).g += 3.0f / 255;                   // fails
  b.at(2, 0) += glm::vec4(glm::vec3(0.1f), 0);  // three channels count as one failure
  const Metrics m = compare(a, b);
  EXPECT_DOUBLE_EQ(m.coverage_mismatch, 1.0 / 200);
  EXPECT_DOUBLE_EQ(m.failing_fraction, 2.0 / 200);
  MetricOptions strict;
  strict.pixel_tolerance = 0;
  EXPECT_DOUBLE_EQ(compare(a, b, strict).failing_fraction, 3.0 / 200);
}

TEST(Metrics, TheUpperPercentileIgnoresOneInAThousand) {
  // 1000 pixels, 3000 values: three may be large, and the fourth largest is the percentile.
  ImageF a = constant(40, 25, glm::vec3(0)), b = a;
  for (int i = 0; i < 3; ++i) b.pixels[i].r = 0.75f;
  EXPECT_EQ(compare(a, b).p999_abs, 0);
  b.pixels[3].r = 0.25f;
  EXPECT_EQ(compare(a, b).p999_abs, 0.25);
  EXPECT_EQ(compare(a, b).max_abs, 0.75);
}

TEST(Metrics, ClampAndSurviveWhatIsNotANumber) {
  ImageF a = constant(16, 16, glm::vec3(1)), b = a;
  a.at(0, 0).r = 7;  // clamps to 1: no difference
  const float nan = std::numeric_limits<float>::quiet_NaN();
  b.at(1, 0) = glm::vec4(glm::vec3(nan), 1);
  const Metrics m = compare(a, b);
  EXPECT_EQ(m.non_finite, 1u);
  EXPECT_EQ(m.max_abs, 1);
  EXPECT_DOUBLE_EQ(m.mae, 1.0 / 256);
  EXPECT_TRUE(std::isfinite(m.ssim));
  EXPECT_TRUE(std::isfinite(m.flip));
}

TEST(Metrics, RefuseWhatCannotBeCompared) {
  const ImageF a(4, 3), b(4, 4);
  EXPECT_THAT(error_of<UsageError>([&] { compare(a, b); }), ErrorAt("", "4 x 3", "4 x 4"));
  EXPECT_THROW(compare({}, {}), UsageError);
  EXPECT_THAT(error_of<UsageError>([&] { ssim(a, a, SsimBorder::valid); }), ErrorAt("", 11));
  EXPECT_NEAR(ssim(a, a, SsimBorder::zero_pad), 1, 1e-12);
}

TEST(Metrics, CompositingShowsTheBackgroundThroughAlpha) {
  ImageF image(1, 1, glm::vec4(1, 0, 0, 0.25f));
  EXPECT_EQ(composited(image, glm::vec3(0, 1, 0)).pixels[0], glm::vec4(0.25f, 0.75f, 0, 0.25f));
}

TEST(Metrics, DifferenceMapHoldsTheLargestChannel) {
  const ImageF a(2, 1, glm::vec4(0.5f));
  ImageF b = a;
  b.at(1, 0) = glm::vec4(0.25f, 0.625f, 0.5f, 0);
  EXPECT_THAT(difference_map(a, b), testing::ElementsAre(0.0f, 0.25f));
}

TEST(Metrics, SkipIgnoredPixels) {
  ImageF a(40, 30, glm::vec4(0.5f)), b = a;
  // The left half differs. Without it all is equal; without the right half, the error is that of
  // the left half alone.
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 20; ++x) b.at(x, y) = glm::vec4(0.6f, 0.6f, 0.6f, 1.0f);
  std::vector<std::uint8_t> right(a.pixels.size(), 1), left(a.pixels.size(), 0);
  for (std::size_t i = 0; i < right.size(); ++i)
    if (i % 40 < 20) right[i] = 0, left[i] = 1;
  const Metrics of_left = compare(a, b, {.ignored = right});
  EXPECT_NEAR(of_left.mse, 0.01, 1e-6);
  EXPECT_NEAR(of_left.mae, 0.1, 1e-6);
  EXPECT_LT(of_left.ssim, compare(a, b).ssim);
  EXPECT_GT(of_left.flip, compare(a, b).flip);
  ImageF equal = b;
  EXPECT_EQ(equate_ignored(a, left, equal), 2);
  const Metrics of_right = compare(a, equal, {.ignored = left});
  EXPECT_EQ(of_right.mse, 0);
  EXPECT_EQ(of_right.ssim, 1);
  EXPECT_EQ(of_right.flip, 0);
}

}  // namespace metrics_test
}  // namespace tureen
