// The oracle's flat Gaussians on their plane, against the intersection in layer coordinates.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "oracle/disc.hpp"
#include "tests/oracle/splats_in_view.hpp"

namespace tureen {
namespace oracle_discs_test {

using oracle::DiscInView;
using oracle::SplatSample;
using oracle::SplatView;

SplatProfile profile_of(const char* name) { return *profile_named(name); }

class OracleDiscs : public testing::Test {
 protected:
  Camera camera_ = test::straight_camera(200, 150, 150);
  test::Random random_{3};

  Gaussians random_disc() {
    return {{{random_.uniform(-1, 1), random_.uniform(-0.7, 0.7), random_.uniform(-5, -2)}},
            {{random_.uniform(0.1, 1), random_.uniform(0.1, 1), 0.5}},
            {test::random_rotation(random_)},
            {0.9f},
            true};
  }
  static Gaussians disc_turned_about_x(double angle) {
    return {{{0, 0, -3}},
            {{0.5f, 0.5f, 0}},
            {glm::quat(float(std::cos(angle / 2)), float(std::sin(angle / 2)), 0, 0)},
            {0.9f},
            true};
  }
};

TEST_F(OracleDiscs, EqualTheDirectIntersection) {
  const SplatView view(glm::dmat4(1.0), camera_, 1e-3);
  const SplatProfile profile = profile_of("redisplats");
  int seen = 0;
  for (int i = 0; i < 300; ++i) {
    const Gaussians gaussians = random_disc();
    const auto disc = DiscInView::project(gaussians, 0, profile, view);
    ASSERT_TRUE(disc);
    const glm::dmat3 axes = glm::mat3_cast(glm::normalize(glm::dquat(gaussians.rotations[0])));
    const glm::dvec3 center(gaussians.centers[0]);
    for (int j = 0; j < 30; ++j) {
      const glm::dvec2 pixel(random_.uniform(0, 200), random_.uniform(0, 150));
      const glm::dvec3 ray = test::point_at(camera_, pixel, 1);
      const double depth = glm::dot(center, axes[2]) / glm::dot(ray, axes[2]);
      const glm::dvec3 hit = depth * ray - center;
      const double u = glm::dot(hit, axes[0]) / double(gaussians.scales[0].x);
      const double v = glm::dot(hit, axes[1]) / double(gaussians.scales[0].y);
      double alpha = double(gaussians.opacity[0]) * std::exp(-0.5 * (u * u + v * v));
      if (alpha < double(profile.min_alpha) || depth < 1e-3) alpha = 0;
      const SplatSample sample = disc->at(pixel);
      EXPECT_NEAR(sample.alpha, alpha, 1e-12);
      if (alpha == 0) continue;
      ++seen;
      EXPECT_NEAR(sample.depth, depth, 1e-9);
      EXPECT_EQ(sample.order, sample.depth);
      // Inside its box.
      EXPECT_TRUE(pixel.x >= disc->box().low.x && pixel.x <= disc->box().high.x);
      EXPECT_TRUE(pixel.y >= disc->box().low.y && pixel.y <= disc->box().high.y);
    }
  }
  EXPECT_GT(seen, 1000);
}

// 2DGS, equation 11: alpha is that of the smaller exponent.
TEST_F(OracleDiscs, AreNeverSmallerThanTheScreenFilter) {
  const SplatView view(glm::dmat4(1.0), camera_, 1e-3);
  for (int i = 0; i < 100; ++i) {
    const Gaussians gaussians = random_disc();
    const auto plain = DiscInView::project(gaussians, 0, profile_of("redisplats"), view);
    const auto filtered = DiscInView::project(gaussians, 0, profile_of("2dgs"), view);
    ASSERT_TRUE(plain && filtered);
    const glm::dvec3 c(gaussians.centers[0]);
    const glm::dvec2 center(100 - 150 * c.x / c.z, 75 + 150 * c.y / c.z);
    for (int j = 0; j < 30; ++j) {
      const glm::dvec2 d(random_.uniform(-3, 3), random_.uniform(-3, 3));
      const double dot = 0.9f * std::exp(-0.5 * glm::dot(d, d) / 0.5);
      const SplatSample a = plain->at(center + d), b = filtered->at(center + d);
      const bool dot_wins = dot > a.alpha;
      if (std::max(dot, a.alpha) < 1.0 / 255) continue;
      EXPECT_NEAR(b.alpha, std::max(dot, a.alpha), 1e-12);
      EXPECT_NEAR(b.depth, dot_wins ? -c.z : a.depth, 1e-12);
    }
  }
}

// docs/numerics.md F11: a 2DGS disc that turns through edge-on becomes a dot and comes back.
TEST_F(OracleDiscs, EdgeOnOnlyTheScreenFilterRemains) {
  const SplatView view(glm::dmat4(1.0), camera_, 1e-3);
  const double quarter = std::acos(-1.0) / 2;
  for (const double tilt : {-1e-3, -1e-6, 0.0, 1e-6, 1e-3}) {
    const Gaussians gaussians = disc_turned_about_x(quarter + tilt);
    const auto filtered = DiscInView::project(gaussians, 0, profile_of("2dgs"), view);
    ASSERT_TRUE(filtered);
    for (const glm::dvec2& d : {glm::dvec2(0.5, 0.5), glm::dvec2(-0.5, -1), glm::dvec2(0, 1.25)})
      EXPECT_NEAR(filtered->at(glm::dvec2(100, 75) + d).alpha, 0.9f * std::exp(-glm::dot(d, d)),
                  1e-3);
  }
  // Exactly edge-on: the local z axis is exactly across the viewing axis.
  Gaussians edge_on = disc_turned_about_x(0);
  edge_on.rotations[0] = glm::quat(std::sqrt(0.5f), std::sqrt(0.5f), 0, 0);
  const auto unfiltered = DiscInView::project(edge_on, 0, profile_of("redisplats"), view);
  if (unfiltered) {
    for (int x = 0; x < 200; ++x)
      for (int y = 0; y < 150; ++y) {
        const double alpha = unfiltered->at({x + 0.5, y + 0.5}).alpha;
        EXPECT_TRUE(alpha >= 0 && alpha <= 1);
      }
  }
}

TEST_F(OracleDiscs, ExistOnlyBeyondTheNearPlane) {
  // Turned by 60 degrees; the near plane goes through its centre.
  const Gaussians gaussians = disc_turned_about_x(std::acos(0.5));
  const SplatView view(glm::dmat4(1.0), camera_, 3.0);
  EXPECT_FALSE(DiscInView::project(gaussians, 0, profile_of("2dgs"), view));
  const auto disc = DiscInView::project(gaussians, 0, profile_of("redisplats"), view);
  ASSERT_TRUE(disc);
  int above = 0, below = 0;
  for (int y = 0; y < 150; ++y)
    if (disc->at({100.0, y + 0.5}).alpha > 0) ++(y < 75 ? above : below);
  EXPECT_EQ(std::min(above, below), 0);
  EXPECT_GT(std::max(above, below), 5);
}

}  // namespace oracle_discs_test
}  // namespace tureen
