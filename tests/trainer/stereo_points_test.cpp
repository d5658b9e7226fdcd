// Points from photographs of a wall with texture, whose lower half has one colour.
#include "trainer/splats/stereo_points.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "trainer/splats/gaussians/gaussian_training.hpp"
#include "trainer/splats/splat_initialise.hpp"

namespace tureen::trainer {
namespace stereo_points_test {

constexpr float black[3] = {0, 0, 0};

glm::u8vec4 wall_color(double x, double y) {
  if (y < 0) return {90, 120, 150, 255};
  // Waves whose lengths change along the wall, so that no two places look alike.
  const double wave = std::sin(9 * x + 5 * x * x) + std::sin(11 * y + 6 * y * y - 3 * x) +
                      std::sin(13.7 * x + 7 * x * y);
  const auto value = std::uint8_t(128 + 40 * wave);
  return {value, value, 50, 255};
}

/// Photographs of the wall z = 0 from around (0, 0, 4).
std::vector<Photograph> wall_photographs(int count, int size = 96) {
  std::vector<Photograph> result;
  for (int k = 0; k < count; ++k) {
    Photograph& view = result.emplace_back();
    view.camera =
        look_at({0.6 * (k - count / 2), 0.3 * (k % 2), 4}, {0, 0, 0}, {0, 1, 0}, 0.7, size, size);
    const glm::dvec3 eye = view.camera.eye();
    Image8 image(size, size);
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        const glm::dvec3 ray = view.camera.world_from_view_rotation() *
                               glm::dvec3((x + 0.5 - view.camera.cx) / view.camera.fx,
                                          (view.camera.cy - y - 0.5) / view.camera.fy, -1);
        const glm::dvec3 point = eye - eye.z / ray.z * ray;
        image.at(x, y) = wall_color(point.x, point.y);
      }
    view.image = std::move(image);
  }
  return result;
}

std::vector<DatasetPoint> points_of(const std::vector<Photograph>& photographs, int threads = 2) {
  return stereo_points(photographs, {.center = {0, 0, 0}, .half_side = 1}, black, 500, 3, threads);
}

TEST(StereoPoints, LieOnASurfaceWithTexture) {
  const auto points = points_of(wall_photographs(5));
  ASSERT_EQ(points.size(), 500u);
  int near = 0;
  for (const DatasetPoint& point : points) {
    // A depth of the sweep is about 0.09 from the next at the wall; a patch at the edge of the
    // texture reaches two pixels of 0.03 into the half without.
    if (std::abs(point.position.z) < 0.05 && point.position.y > -0.06) ++near;
  }
  EXPECT_GE(near, 475);  // patches at the edge of the texture agree at wrong depths, too
}

TEST(StereoPoints, HaveTheColorsOfTheirPixels) {
  int right = 0;
  const auto points = points_of(wall_photographs(5));
  for (const DatasetPoint& point : points)
    right += std::abs(point.color.r - wall_color(point.position.x, point.position.y).r) < 12;
  EXPECT_GE(right, int(points.size()) * 9 / 10);  // near the edge, points of both halves
}

TEST(StereoPoints, AreTheSameWithAnyNumberOfThreads) {
  const auto photographs = wall_photographs(5);
  const auto once = points_of(photographs, 1), again = points_of(photographs, 3);
  ASSERT_EQ(once.size(), again.size());
  for (std::size_t i = 0; i < once.size(); ++i) {
    EXPECT_EQ(once[i].position, again[i].position);
    EXPECT_EQ(once[i].color, again[i].color);
  }
}

TEST(StereoPoints, NoneIsInIgnoredPixels) {
  auto photographs = wall_photographs(5);
  for (Photograph& view : photographs) {
    std::vector<std::uint8_t> ignored(96 * 96);
    for (std::size_t i = 0; i < ignored.size(); ++i) ignored[i] = i % 96 < 48;
    view.ignored = std::move(ignored);
  }
  const auto points = points_of(photographs);
  ASSERT_GT(points.size(), 100u);
  const auto left = std::ranges::count_if(
      points, [](const DatasetPoint& point) { return point.position.x < -0.1; });
  EXPECT_LE(left, std::ptrdiff_t(points.size() / 20));  // those at wrong depths
}

/// The fraction of the first splats that lie near the wall.
double share_near_wall(const GaussianConfig& config) {
  Dataset dataset;
  dataset.train = wall_photographs(5);
  Random random(1);
  const GaussianParameters first = initial_splats<GaussianTraining>(
      dataset, config, {.center = {0, 0, 0}, .half_side = 1}, nullptr, random);
  const float* z = first.drawn.row(splatting::gaussian_row::z);
  return double(std::count_if(z, z + first.count(), [](float at) { return std::abs(at) < 0.05; })) /
         double(first.count());
}

TEST(StereoPoints, AreTheFirstSplatsOfAPlaceWithoutPoints) {
  GaussianConfig config{{.first_splats = 200, .far_splats = 0.5}};
  EXPECT_GT(share_near_wall(config), 0.9);
  config.initialisation = Initialisation::random;
  EXPECT_LT(share_near_wall(config), 0.1);  // 0.05 of the cube's 1, and half of them far
  config = {{.first_splats = 200}};         // an object: random in the cube
  EXPECT_LT(share_near_wall(config), 0.1);
}

TEST(StereoPoints, AreNoneWhereNothingCanBeMeasured) {
  EXPECT_THAT(points_of(wall_photographs(2)), testing::IsEmpty());
  EXPECT_THAT(points_of(wall_photographs(5, 4)), testing::IsEmpty());
  std::vector<Photograph> same(5, wall_photographs(1)[0]);  // all from one point
  EXPECT_THAT(points_of(same), testing::IsEmpty());
}

}  // namespace stereo_points_test
}  // namespace tureen::trainer
