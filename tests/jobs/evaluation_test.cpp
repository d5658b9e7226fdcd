// The parts of an evaluation that need no dataset files.
#include "jobs/eval/evaluation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"

namespace tureen {
namespace evaluation_test {

/// A grey triangle that fills the view of the camera in photograph().
TriangleSoup grey_wall(glm::u8vec4 color) {
  TriangleSoup soup;
  soup.positions = {{-50, -50, 0}, {50, -50, 0}, {0, 90, 0}};
  soup.triangles = {{0, 1, 2}};
  soup.appearance = FaceColors{{glm::vec4(color) / 255.0f}};
  return soup;
}

Photograph photograph(const std::string& name, glm::u8vec4 color) {
  Photograph result;
  result.camera = look_at({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 0.7, 32, 24);
  result.camera.name = name;
  result.image = Image8(32, 24, color);
  return result;
}

TEST(Evaluate, GivesEachViewItsNumbersAndTheirMean) {
  const std::vector<Photograph> photographs{photograph("same", {100, 100, 100, 255}),
                                            photograph("brighter", {151, 151, 151, 255}),
                                            photograph("clear", {0, 0, 0, 0})};
  const Evaluation result = evaluate(grey_wall({100, 100, 100, 255}), glm::dvec3(0), photographs,
                                     {.backend = gl::Backend::osmesa, .background = glm::vec3(1)});
  ASSERT_EQ(result.views.size(), 3u);
  EXPECT_EQ(result.views[0].name, "same");
  EXPECT_EQ(result.views[0].psnr_db, 100);
  EXPECT_NEAR(result.views[0].ssim, 1, 1e-12);
  EXPECT_EQ(result.views[0].flip, 0);
  // 51 / 255 is one fifth: -20 log10 0.2. Float rounding of the values is 6e-8.
  EXPECT_NEAR(result.views[1].psnr_db, 13.979400086720377, 1e-5);
  EXPECT_GT(result.views[1].flip, 0);
  // A transparent photograph shows the white background.
  EXPECT_NEAR(result.views[2].psnr_db, -20 * std::log10(155.0 / 255), 1e-5);
  for (const ViewMetrics& view : result.views) {
    EXPECT_EQ(view.holes, 0);
    EXPECT_EQ(view.specks, 0);
  }
  for (double ViewMetrics::*value : {&ViewMetrics::psnr_db, &ViewMetrics::ssim, &ViewMetrics::flip})
    EXPECT_NEAR(result.mean.*value,
                (result.views[0].*value + result.views[1].*value + result.views[2].*value) / 3,
                1e-12);
}

TEST(Evaluate, CountsHolesInsideTheSilhouette) {
  TriangleSoup half = grey_wall({100, 100, 100, 255});
  half.positions = {{-50, -50, 0}, {0, -50, 0}, {0, 50, 0}};  // right of the middle is nothing
  std::vector<Photograph> photographs{photograph("opaque", {100, 100, 100, 255}),
                                      photograph("upper half", {100, 100, 100, 255})};
  Image8 image = photographs[1].image();
  for (int i = 32 * 12; i < 32 * 24; ++i) image.pixels[std::size_t(i)].a = 0;
  photographs[1].image = image;
  const Evaluation result = evaluate(half, glm::dvec3(0), photographs,
                                     {.backend = gl::Backend::osmesa, .background = glm::vec3(1)});
  EXPECT_EQ(result.views[0].holes, 0.5);
  EXPECT_EQ(result.views[1].holes, 0.5);
  EXPECT_EQ(result.mean.holes, 0.5);
}

TEST(Evaluate, SkipsPixelsThatAMaskExcludes) {
  // The upper half is wrong by one fifth. Without it, the lower half is the same; without the lower
  // half, all counted pixels are wrong.
  Photograph upper = photograph("upper", {100, 100, 100, 255});
  Image8 image = upper.image();
  const std::size_t half = image.pixels.size() / 2;
  std::fill_n(image.pixels.begin(), half, glm::u8vec4(151, 151, 151, 255));
  upper.image = image;
  std::vector<std::uint8_t> ignored(2 * half, 0);
  std::fill_n(ignored.begin(), half, 1);
  upper.ignored = ignored;
  Photograph lower = upper;
  for (std::uint8_t& pixel : ignored) pixel = pixel ? 0 : 1;
  lower.ignored = ignored;
  const Evaluation result = evaluate(grey_wall({100, 100, 100, 255}), glm::dvec3(0),
                                     std::vector{upper, lower}, {.backend = gl::Backend::osmesa});
  EXPECT_EQ(result.views[0].psnr_db, 100);
  EXPECT_NEAR(result.views[0].ssim, 1, 1e-12);
  EXPECT_EQ(result.views[0].flip, 0);
  EXPECT_NEAR(result.views[1].psnr_db, 13.979400086720377, 1e-5);
  EXPECT_GT(result.views[1].ssim, 0);
  EXPECT_LT(result.views[1].ssim, 0.999);
  EXPECT_GT(result.views[1].flip, 0.1);
  EXPECT_LE(result.views[1].flip, 1);
}

TEST(Evaluate, EndsWhereItsProgressThrows) {
  std::vector<Photograph> photographs(20, photograph("grey", {100, 100, 100, 255}));
  EvaluationOptions options{.backend = gl::Backend::osmesa};
  options.progress = [](double fraction) {
    if (fraction > 0.5) throw UsageError("enough");
  };
  EXPECT_THROW(evaluate(grey_wall({100, 100, 100, 255}), glm::dvec3(0), photographs, options),
               UsageError);
}

TEST(Evaluate, RefusesViewsThatTheWindowDoesNotFitInto) {
  Photograph small = photograph("small", {0, 0, 0, 255});
  small.camera = resized(small.camera, 8, 8);
  small.image = Image8(8, 8);
  const std::vector<Photograph> photographs{small};
  EXPECT_THROW(evaluate(grey_wall({100, 100, 100, 255}), glm::dvec3(0), photographs,
                        {.backend = gl::Backend::osmesa}),
               UsageError);
}

}  // namespace evaluation_test
}  // namespace tureen
