// Errors over several views.
#include "image/render_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "base/error.hpp"

namespace tureen {
namespace render_error_test {

ImageF gray(int width, int height, float value, float alpha = 1) {
  return {width, height, glm::vec4(value, value, value, alpha)};
}

TEST(RenderError, PoolsSquaredErrorsNotDecibels) {
  // Views at 20, 30 and 40 dB: the mean of decibels is 30 dB, that of squared errors 24.3 dB.
  RenderErrorMeter meter;
  for (const double db : {20.0, 30.0, 40.0})
    meter.add(gray(16, 16, 0.5f), gray(16, 16, float(0.5 + std::pow(10.0, -db / 20))));
  const RenderError error = meter.result();
  // Float images preserve the differences to about 1e-7.
  EXPECT_NEAR(error.mean_psnr_db, 30, 1e-4);
  EXPECT_NEAR(error.worst_psnr_db, 20, 1e-4);
  EXPECT_NEAR(error.mse, (1e-2 + 1e-3 + 1e-4) / 3, 1e-8);
  EXPECT_NEAR(error.psnr_db, 24.3180, 1e-3);
  EXPECT_NEAR(error.max_abs, 0.1, 1e-6);
  ASSERT_EQ(error.view_psnr_db.size(), 3u);
  EXPECT_NEAR(error.view_psnr_db[2], 40, 1e-3);
}

TEST(RenderError, WeighsViewsByTheirPixels) {
  RenderErrorMeter meter;
  meter.add(gray(16, 16, 0), gray(16, 16, 0.25f));
  meter.add(gray(48, 16, 0), gray(48, 16, 0));
  const RenderError error = meter.result();
  EXPECT_DOUBLE_EQ(error.mae, 0.25 / 4);
  EXPECT_DOUBLE_EQ(error.mse, 0.0625 / 4);
}

TEST(RenderError, OneViewIsWhatCompareSays) {
  const std::uint32_t seed = 7;
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 engine(seed);
  ImageF a(40, 30), b(40, 30);
  const auto number = [&] { return float(engine() % 65536) / 65535; };
  for (ImageF* image : {&a, &b})
    for (glm::vec4& pixel : image->pixels) pixel = {number(), number(), number(), number()};
  RenderErrorMeter meter;
  meter.add(a, b);
  const RenderError error = meter.result();
  const Metrics metrics = compare(a, b);
  EXPECT_EQ(error.mae, metrics.mae);
  EXPECT_EQ(error.mse, metrics.mse);
  EXPECT_EQ(error.psnr_db, metrics.psnr_db);
  EXPECT_EQ(error.max_abs, metrics.max_abs);
  EXPECT_EQ(error.ssim, metrics.ssim);
  EXPECT_EQ(error.flip, metrics.flip);
  EXPECT_EQ(error.coverage_mismatch, metrics.coverage_mismatch);
  EXPECT_GT(error.coverage_mismatch, 0.4);
  EXPECT_GE(error.p999_abs, metrics.p999_abs);
  EXPECT_LE(error.p999_abs, metrics.p999_abs + 1.0 / 65536);
}

TEST(RenderError, TheHighPercentileIsThatOfAllViewsTogether) {
  // 2 of 2,000 pixels are off by a half: exactly the thousandth that the percentile ignores. A
  // third pixel counts.
  RenderErrorMeter meter;
  ImageF bad = gray(40, 25, 0);
  bad.at(0, 0) = bad.at(5, 5) = glm::vec4(glm::vec3(0.5f), 1);
  meter.add(gray(40, 25, 0), bad);
  meter.add(gray(40, 25, 0), gray(40, 25, 0));
  EXPECT_EQ(meter.result().p999_abs, 0);
  RenderErrorMeter other;
  bad.at(6, 6) = bad.at(0, 0);
  other.add(gray(40, 25, 0), bad);
  other.add(gray(40, 25, 0), gray(40, 25, 0));
  EXPECT_NEAR(other.result().p999_abs, 0.5, 1.0 / 65536);
}

TEST(RenderError, EqualImagesAndImagesThatDoNotFit) {
  RenderErrorMeter meter;
  meter.add(gray(16, 16, 0.3f), gray(16, 16, 0.3f));
  EXPECT_EQ(meter.result().psnr_db, 100);
  EXPECT_EQ(meter.result().p999_abs, 0);
  EXPECT_NEAR(meter.result().ssim, 1, 1e-12);
  EXPECT_THROW(meter.add(gray(16, 16, 0), gray(16, 15, 0)), UsageError);
}

TEST(DecibelsLost, AreThoseOfAddedErrors) {
  // The table of the error budget: a model of 27 dB, drawn at 40, 45, 50 and 55 dB.
  EXPECT_NEAR(decibels_lost(27, 40), 0.212, 1e-3);
  EXPECT_NEAR(decibels_lost(27, 45), 0.068, 1e-3);
  EXPECT_NEAR(decibels_lost(27, 50), 0.022, 1e-3);
  EXPECT_NEAR(decibels_lost(27, 55), 0.007, 1e-3);
}

}  // namespace render_error_test
}  // namespace tureen
