// On the clouds of the speed benchmarks, our plan's error is not larger than the baseline's.
#include <gtest/gtest.h>

#include "image/metrics.hpp"
#include "tests/support/agreement.hpp"
#include "tests/support/cutout_cloud.hpp"

namespace tureen {
namespace baseline_error_test {

class BaselineError : public testing::TestWithParam<test::CloudCoverage> {};

TEST_P(BaselineError, IsNoSmallerThanOurs) {
  const Scene scene = test::cutout_cloud({.coverage = GetParam()});
  const auto& soup = only_soup(scene);
  gl::Context context = gl::Context::create({});
  double ours = 0, baseline = 0;
  // Every second view. In either pipeline, one to eight pixels of a view fall to the other side of
  // an edge. A small image has too few of them for a mean.
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
  // Both must be images of this cloud. 40 dB correspond to 3 of 10^4 pixels with an error of 0.6.
  EXPECT_GT(psnr_from_mse(baseline), 40);
}

constexpr auto name_of = [](const auto& cloud) {
  return std::string(cloud.param == test::CloudCoverage::all ? "covers_all"
                                                             : "covers_forty_percent");
};
INSTANTIATE_TEST_SUITE_P(Cloud, BaselineError, testing::Values(test::CloudCoverage::forty_percent),
                         name_of);
INSTANTIATE_TEST_SUITE_P(ThoroughCloud, BaselineError, testing::Values(test::CloudCoverage::all),
                         name_of);

}  // namespace baseline_error_test
}  // namespace tureen
