// The parts of the measurement of growth that can be wrong without anybody noticing.
#include "bench/cost_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "bench/layered_soup.hpp"
#include "support/random.hpp"

namespace tureen::test {
namespace {

std::vector<CostSample> samples(const std::array<double, 4>& ms, double noise, Random& random) {
  std::vector<CostSample> result;
  for (double triangles = 1e3; triangles < 5e6; triangles *= 4)
    for (const double pixels : {1e5, 4e5, 2e6})
      for (const double layers : {1.0, 4.0, 16.0}) {
        CostSample sample{triangles, pixels * layers, pixels, 0};
        sample.ms = ms[0] + ms[1] * triangles + ms[2] * sample.fragments + ms[3] * pixels;
        sample.ms *= 1 + noise * random.normal();
        result.push_back(sample);
      }
  return result;
}

constexpr std::array<double, 4> truth{0.5, 2e-5, 3e-6, 4e-5};

TEST(CostFit, FindsTheCostsThatMadeTheTimes) {
  Random random(1);
  const auto fit = fit_costs(samples(truth, 0, random));
  ASSERT_TRUE(fit);
  // Rounding alone, amplified by the condition of the columns.
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(fit->ms[i] / truth[i], 1, 1e-8) << i;
  for (const double residual : fit->residuals) EXPECT_NEAR(residual, 0, 1e-10);
}

TEST(CostFit, KnowsHowWrongItMayBe) {
  const unsigned seed = 3;
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  Random random(seed);
  const auto fit = fit_costs(samples(truth, 0.05, random));
  ASSERT_TRUE(fit);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_GT(fit->standard_error[i], 0);
    // Four standard errors: one draw in 10^4 lies beyond, and the seed is fixed.
    EXPECT_LT(std::abs(fit->ms[i] - truth[i]), 4 * fit->standard_error[i]) << i;
    EXPECT_LT(fit->standard_error[i], 0.3 * truth[i]) << i;
  }
}

TEST(CostFit, SaysNothingWhereTheSamplesDoNotTellCostsApart) {
  Random random(1);
  std::vector<CostSample> all = samples(truth, 0, random);
  for (CostSample& sample : all) sample.fragments = 3 * sample.shaded_pixels;
  EXPECT_FALSE(fit_costs(all));
  all.resize(4);
  EXPECT_FALSE(fit_costs(all));
}

/// Twice the signed area of a triangle in pixels.
double projected_area(const Camera& camera, const TriangleSoup& soup, glm::uvec3 face) {
  glm::dvec2 pixel[3];
  for (int k = 0; k < 3; ++k) {
    const glm::dvec4 view = camera.view_from_world * glm::dvec4(soup.positions[face[k]], 1);
    pixel[k] = {camera.cx + camera.fx * view.x / -view.z, camera.cy - camera.fy * view.y / -view.z};
    EXPECT_TRUE(pixel[k].x >= 0 && pixel[k].x <= camera.width && pixel[k].y >= 0 &&
                pixel[k].y <= camera.height);
  }
  const glm::dvec2 a = pixel[1] - pixel[0], b = pixel[2] - pixel[0];
  return std::abs(a.x * b.y - a.y * b.x);
}

TEST(LayeredSoup, MakesTheFragmentsThatItSays) {
  for (const auto kind : {LayeredSoupOptions::Kind::opaque, LayeredSoupOptions::Kind::cut_out})
    for (const int layers : {1, 5}) {
      const LayeredSoupOptions options{.triangles = 2000, .layers = layers, .kind = kind};
      const Scene scene = layered_soup(options);
      const auto& soup = std::get<TriangleSoup>(scene.primitives);
      EXPECT_FALSE(defect(soup));
      EXPECT_GE(soup.triangles.size(), 2000u);
      EXPECT_LT(soup.triangles.size(), 2400u);
      const Camera camera = resized(scene.cameras[0], 640, 360);
      double area = 0;
      for (const glm::uvec3 face : soup.triangles) area += 0.5 * projected_area(camera, soup, face);
      // Positions are floats.
      EXPECT_NEAR(area / layered_soup_fragments(options, 640, 360), 1, 1e-5);
    }
}

/// Mean of the lengths of all edges, in units of the positions.
double mean_edge(const Scene& scene) {
  const auto& soup = std::get<TriangleSoup>(scene.primitives);
  double sum = 0;
  for (const glm::uvec3 face : soup.triangles)
    for (int k = 0; k < 3; ++k)
      sum += glm::distance(glm::dvec3(soup.positions[face[k]]),
                           glm::dvec3(soup.positions[face[(k + 1) % 3]]));
  return sum / double(3 * soup.triangles.size());
}

TEST(LayeredSoup, LongerCellsHaveLongerEdgesAlone) {
  const double compact = mean_edge(layered_soup({.triangles = 65536}));
  for (const double elongation : {4.0, 16.0}) {
    SCOPED_TRACE(elongation);
    const LayeredSoupOptions options{.triangles = 65536, .elongation = elongation};
    const Scene scene = layered_soup(options);
    const auto& soup = std::get<TriangleSoup>(scene.primitives);
    EXPECT_GE(soup.triangles.size(), 65536u);
    // Cells are whole: rows of 30 leave some more of them.
    EXPECT_LT(soup.triangles.size(), 65536 * 1.01);
    // Every triangle is half a cell.
    const glm::dvec3 corners[] = {soup.positions[0], soup.positions[1], soup.positions[2]};
    const glm::dvec3 size = glm::max(glm::max(corners[0], corners[1]), corners[2]) -
                            glm::min(glm::min(corners[0], corners[1]), corners[2]);
    EXPECT_NEAR(size.x / size.y / elongation, 1, 0.02) << "whole cells, as above";
    double area = 0;
    for (const glm::uvec3 face : soup.triangles)
      area += 0.5 * projected_area(scene.cameras[0], soup, face);
    // Positions are floats, edges of a thin triangle a part of it.
    EXPECT_NEAR(area / layered_soup_fragments(options, 1280, 720), 1, 1e-4);
    // Both sides and the diagonal of a cell of the same area; whole cells, as above.
    const double along = std::sqrt(elongation), across = 1 / along;
    EXPECT_NEAR(mean_edge(scene) / compact,
                (along + across + std::hypot(along, across)) / (2 + std::sqrt(2.0)), 0.02);
  }
}

}  // namespace
}  // namespace tureen::test
