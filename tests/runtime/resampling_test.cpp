// Supersampling and resolution scale filter as documented, with every shading site and pipeline.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "base/error.hpp"
#include "jobs/baseline/baseline.hpp"
#include "runtime/passes/filter_pass.hpp"
#include "tests/runtime/quality_drawing.hpp"
#include "tests/support/contexts.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/renderer_of.hpp"
#include "tests/support/samples.hpp"

namespace tureen::test {
namespace resampling_test {

/// The weighted mean of samples that the shaders should compute. Colours are weighted by alpha, or
/// unweighted where all samples are transparent.
struct WeightedMean {
  glm::dvec4 sum{0.0};
  glm::dvec3 plain{0.0};

  void add(glm::u8vec4 sample, double weight) {
    const glm::dvec4 value = glm::dvec4(sample) / 255.0;
    sum += weight * glm::dvec4(glm::dvec3(value) * value.a, value.a);
    plain += weight * glm::dvec3(value);
  }
  glm::dvec4 result() const {
    return sum.a > 0 ? glm::dvec4(glm::dvec3(sum) / sum.a, sum.a) : glm::dvec4(plain, 0.0);
  }
};

/// Half a step of rounding, plus float errors and double rounding near one half.
void expect_filtered(const Image8& drawn, const std::function<glm::dvec4(int, int)>& expected) {
  double worst = 0;
  for (int y = 0; y < drawn.height; ++y)
    for (int x = 0; x < drawn.width; ++x)
      for (int c = 0; c < 4; ++c)
        worst = std::max(worst, std::abs(255 * expected(x, y)[c] - drawn.at(x, y)[c]));
  EXPECT_LE(worst, 0.5 + 1e-3);
}

struct Variant {
  const char* name;
  PlanPreferences plan = {};
  PipelineKind pipeline = PipelineKind::tureen;
};

const Variant variants[] = {
    {"deferred", {.site = ShadingSite::deferred}},
    {"forward", {.site = ShadingSite::forward}},
    {.name = "baseline", .pipeline = PipelineKind::baseline},
};

class Resampling : public testing::TestWithParam<InContext<Variant>> {
 protected:
  RenderOptions options(float background_alpha) const {
    RenderOptions result{.plan = variant.plan, .limits = {}};
    result.background = glm::vec4(0.9f, 0.2f, 0.5f, background_alpha);
    return result;
  }
  Image8 draw(const Camera& camera, const RenderOptions& options) const {
    Renderer renderer = make_renderer(context, soup, {}, variant.pipeline, options);
    renderer.draw({camera});
    return renderer.read_color();
  }
  const gl::Context context = gl::Context::create(std::get<0>(GetParam()).request);
  const Variant variant = std::get<1>(GetParam());
  const TriangleSoup soup = random_soup(22, {.kind = Kind::lattice_mlp, .size = 0.3, .level = 2});
};

// A supersampled image is the mean of an image n times as large.
TEST_P(Resampling, SupersamplingIsTheMeanOfALargerImage) {
  const Camera camera = camera_of(61, 43);
  for (const int n : {2, 3, 8}) {
    SCOPED_TRACE(n);
    RenderOptions all = options(n == 3 ? 0.0f : 1.0f);
    const Image8 large = draw(resampled(camera, 61 * n, 43 * n), all);
    all.plan.quality.supersampling = n;
    expect_filtered(draw(camera, all), [&](int x, int y) {
      WeightedMean mean;
      for (int i = 0; i < n * n; ++i)
        mean.add(large.at(n * x + i % n, n * y + i / n), 1.0 / (n * n));
      return mean.result();
    });
  }
}

TEST_P(Resampling, ScaleInterpolatesASmallerImage) {
  const Camera camera = camera_of(61, 43);
  for (const double scale : {0.25, 0.5, 0.9}) {
    SCOPED_TRACE(scale);
    RenderOptions all = options(scale == 0.5 ? 0.0f : 1.0f);
    const auto width = int(std::lround(61 * scale)), height = int(std::lround(43 * scale));
    const Image8 small = draw(resampled(camera, width, height), all);
    all.plan.quality.resolution_scale = scale;
    expect_filtered(draw(camera, all), [&](int x, int y) {
      const double u = std::clamp((x + 0.5) * width / 61.0 - 0.5, 0.0, width - 1.0);
      const double v = std::clamp((y + 0.5) * height / 43.0 - 0.5, 0.0, height - 1.0);
      const int left = int(u), top = int(v);
      const int right = std::min(left + 1, width - 1), bottom = std::min(top + 1, height - 1);
      WeightedMean mean;
      mean.add(small.at(left, top), (1 - u + left) * (1 - v + top));
      mean.add(small.at(right, top), (u - left) * (1 - v + top));
      mean.add(small.at(left, bottom), (1 - u + left) * (v - top));
      mean.add(small.at(right, bottom), (u - left) * (v - top));
      return mean.result();
    });
  }
}

INSTANTIATE_TEST_SUITE_P(, Resampling, in_contexts(variants), name_in_context);
INSTANTIATE_TEST_SUITE_P(Thorough, Resampling, in_other_contexts(variants), name_in_context);

TEST(ResamplingLimits, MoreSamplesThanTheDeviceDrawsAreRefusedAndTheNextFrameIsDrawn) {
  const gl::Context context = gl::Context::create(osmesa);
  const TriangleSoup soup = soup_of(Kind::face_colors);
  Renderer renderer = renderer_of(context, soup, {}, options_with({.supersampling = 8}));
  const int side = context.capabilities().max_image_side;
  renderer.draw({camera_of(16, 12)});
  const Image8 before = renderer.read_color();
  EXPECT_THAT(error_of<DeviceLimitError>([&] { renderer.draw({camera_of(side / 8 + 1, 10)}); }),
              Names(std::to_string(8 * (side / 8 + 1)) + "x80", side));
  renderer.draw({camera_of(16, 12)});
  EXPECT_EQ(renderer.read_color().pixels, before.pixels);
}

}  // namespace resampling_test
}  // namespace tureen::test
