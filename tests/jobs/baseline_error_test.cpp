// The clouds that speed is measured on: what our plan gains in time over the baseline is
// not paid for in error.
#include <gtest/gtest.h>

#include "image/metrics.hpp"
#include "tests/support/agreement.hpp"
#include "tests/support/cutout_cloud.hpp"

namespace tureen {
namespace baseline_error_test {

class BaselineError : public testing::TestWithParam<test::CloudCoverage> {};

TEST_P(BaselineError, IsNoSmallerThanOurs) {
  const Scene scene = test::cutout_cloud({.coverage = GetParam()});
  const auto& soup = std::get<TriangleSoup>(scene.primitives);
  gl::Context context = gl::Context::create({});
  double ours = 0, baseline = 0;
  // Every second one. A view has one to eight pixels that fall to the other side of an edge, in
  // either pipeline: a small image has too few of them for a mean.
  for (const std::size_t view : {1, 3, 5, 7}) {
    const Camera& camera = scene.cameras[view];
    const ImageF exact = composited(test::snapped_oracle(soup, {}, camera).color, glm::vec3(0));
    const auto error_of = [&](const test::Drawn& drawn) {
      return mean_squared_error(exact, to_float(drawn.color)) / 4;
    };
    ours += error_of(test::draw(context, soup, {}, camera, {}));
    baseline += error_of(test::draw_baseline(context, soup, {}, camera));
  }
  RecordProperty("ours_db", std::to_string(psnr_from_mse(ours)));
  RecordProperty("baseline_db", std::to_string(psnr_from_mse(baseline)));
  EXPECT_LE(ours, baseline);
  // Both are images of this cloud: 40 dB is what 3 pixels in 10^4 leave that are off by 0.6.
  EXPECT_GT(psnr_from_mse(baseline), 40);
}

INSTANTIATE_TEST_SUITE_P(Cloud, BaselineError,
                         testing::Values(test::CloudCoverage::forty_percent,
                                         test::CloudCoverage::all),
                         [](const auto& cloud) {
                           return cloud.param == test::CloudCoverage::all
                                      ? std::string("covers_all")
                                      : std::string("covers_forty_percent");
                         });

}  // namespace baseline_error_test
}  // namespace tureen
