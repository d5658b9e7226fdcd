// On the clouds of the speed benchmarks, our plan's error is not larger than the baseline's.
#include <gtest/gtest.h>

#include "image/metrics.hpp"
#include "tests/support/agreement.hpp"
#include "tests/support/cutout_cloud.hpp"

namespace tureen {
namespace published_error_test {

class BaselineError : public testing::TestWithParam<test::CloudCoverage> {};

TEST_P(BaselineError, IsNoSmallerThanOurs) {
  const Scene scene = test::cutout_cloud({.coverage = GetParam()});
  const auto& soup = std::get<TriangleSoup>(scene.primitives);
  gl::Context context = gl::Context::create({});
  double ours = 0, published = 0;
  // Every second view. In either pipeline, one to eight pixels of a view fall to the other side of
  // an edge. A small image has too few of them for a mean.
  for (const std::size_t view : {1, 3, 5, 7}) {
    const Camera& camera = scene.cameras[view];
    const ImageF exact = composited(test::snapped_oracle(soup, {}, camera).color, glm::vec3(0));
    const auto error_of = [&](PipelineKind pipeline) {
      const test::Drawn drawn = test::draw(context, soup, {}, camera, {.pipeline = pipeline});
      return mean_squared_error(exact, to_float(drawn.color)) / 4;
    };
    ours += error_of(PipelineKind::tureen);
    published += error_of(PipelineKind::baseline);
  }
  RecordProperty("ours_db", std::to_string(psnr_from_mse(ours)));
  RecordProperty("published_db", std::to_string(psnr_from_mse(published)));
  EXPECT_LE(ours, published);
  // Both must be images of this cloud. 40 dB correspond to 3 of 10^4 pixels with an error of 0.6.
  EXPECT_GT(psnr_from_mse(published), 40);
}

INSTANTIATE_TEST_SUITE_P(Cloud, BaselineError,
                         testing::Values(test::CloudCoverage::forty_percent,
                                         test::CloudCoverage::all),
                         [](const auto& cloud) {
                           return cloud.param == test::CloudCoverage::all
                                      ? std::string("covers_all")
                                      : std::string("covers_forty_percent");
                         });

}  // namespace published_error_test
}  // namespace tureen
