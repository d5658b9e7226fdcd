// The near zone of cameras, compared with a search over many points of each triangle.
#include "trainer/diffsoup/near_zone.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "tests/support/random.hpp"
#include "tests/trainer/random_model.hpp"
#include "tests/trainer/stages.hpp"

namespace tureen::trainer {
namespace near_zone_test {

using tureen::test::Random;

bool in_near_zone(const Camera& camera, glm::dvec3 point, double near) {
  const glm::dvec4 v = camera.view_from_world * glm::dvec4(point, 1.0);
  const double w = -v.z;
  if (!(w > 0 && w <= near)) return false;
  const double x = camera.cx + camera.fx * v.x / w, y = camera.cy - camera.fy * v.y / w;
  return x >= 0 && x <= camera.width && y >= 0 && y <= camera.height;
}

/// Whether some point of a grid on the triangle is in the near zone.
bool some_point_in_near_zone(const Model& model, std::size_t face, const Camera& camera,
                             double near) {
  constexpr int steps = 300;
  const glm::vec3* corner = &model.positions[3 * face];
  for (int i = 0; i <= steps; ++i)
    for (int j = 0; i + j <= steps; ++j) {
      const double b0 = double(i) / steps, b1 = double(j) / steps;
      const glm::dvec3 point = b0 * glm::dvec3(corner[0]) + b1 * glm::dvec3(corner[1]) +
                               (1 - b0 - b1) * glm::dvec3(corner[2]);
      if (in_near_zone(camera, model.origin + point, near)) return true;
    }
  return false;
}

Model triangle(glm::vec3 a, glm::vec3 b, glm::vec3 c) {
  Model model = test::random_model(1, {.faces = 1, .max_level = 0});
  model.origin = glm::dvec3(0.0);
  model.positions = {a, b, c};
  return model;
}

bool reaches(const Model& model) {
  const Camera camera = test::axis_camera(100, 80, 50);  // at depth 1: 2 x 1.6
  return reaching_near_zone(model, {&camera, 1}, 1.0)[0] != 0;
}

TEST(NearZone, IsWhereSomePointOfTheTriangleIs) {
  Random random(2);
  const Model model = test::random_model(3, {.faces = 300, .max_level = 0});
  int reaching = 0, differing = 0;
  for (int trial = 0; trial < 3; ++trial) {
    const Camera camera = look_at(model.origin + 2.0 * random.direction(),
                                  model.origin + 0.3 * random.direction(), {0, 0, 1}, 0.7, 90, 60);
    const auto found = reaching_near_zone(model, {&camera, 1}, 1.2);
    for (std::size_t face = 0; face < model.faces(); ++face) {
      const bool expected = some_point_in_near_zone(model, face, camera, 1.2);
      reaching += expected;
      // The grid may miss a corner that is barely inside, but finds no point outside.
      if (expected) {
        EXPECT_TRUE(found[face]) << face;
      }
      differing += expected != (found[face] != 0);
    }
  }
  EXPECT_GT(reaching, 50);
  EXPECT_LE(differing, reaching / 20);
}

TEST(NearZone, TakesAllCamerasTogether) {
  const Model model = test::random_model(4, {.faces = 200, .max_level = 0});
  Random random(5);
  std::vector<Camera> cameras;
  for (int i = 0; i < 4; ++i)
    cameras.push_back(
        look_at(model.origin + 2.0 * random.direction(), model.origin, {0, 0, 1}, 0.5, 90, 60));
  const auto all = reaching_near_zone(model, cameras, 1.0);
  for (std::size_t face = 0; face < model.faces(); ++face) {
    bool any = false;
    for (const Camera& camera : cameras)
      any = any || reaching_near_zone(model, {&camera, 1}, 1.0)[face];
    EXPECT_EQ(all[face] != 0, any) << face;
  }
}

TEST(NearZone, HoldsNothingBehindBeyondOrBeside) {
  EXPECT_TRUE(reaches(triangle({0, 0, -0.5f}, {0.1f, 0, -0.5f}, {0, 0.1f, -0.5f})));
  EXPECT_FALSE(reaches(triangle({0, 0, 0.5f}, {0.1f, 0, 0.5f}, {0, 0.1f, 0.5f})));
  EXPECT_FALSE(reaches(triangle({0, 0, -1.5f}, {0.1f, 0, -1.5f}, {0, 0.1f, -1.5f})));
  EXPECT_FALSE(reaches(triangle({2, 0, -0.5f}, {2.1f, 0, -0.5f}, {2, 0.1f, -0.5f})));
  // No corner is inside, but the triangle crosses the zone.
  EXPECT_TRUE(reaches(triangle({-9, -9, -0.5f}, {9, -9, -0.5f}, {0, 9, -0.5f})));
  // From behind the eye to beyond the zone, through it and beside it.
  EXPECT_TRUE(reaches(triangle({0, 0, 5}, {0.1f, 0, -5}, {-0.1f, 0, -5})));
  EXPECT_FALSE(reaches(triangle({9, 0, 5}, {9.1f, 0, -5}, {8.9f, 0, -5})));
}

TEST(NearZone, HoldsNoPositionThatIsNoNumber) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(reaches(triangle({nan, nan, nan}, {nan, nan, nan}, {nan, nan, nan})));
}

// Coordinates of such triangles are mostly rounding errors. The sanitizer checks the memory used
// for clipping.
TEST(NearZone, TakesTrianglesAtTheVeryEye) {
  Random random(5);
  std::vector<Camera> cameras;
  for (int i = 0; i < 20; ++i) {
    const glm::dvec3 forward = random.direction();
    cameras.push_back(look_at(glm::dvec3(0.0), forward, random.direction(), 0.7, 90, 60));
  }
  Model model = test::random_model(6, {.faces = 3000, .max_level = 0});
  model.origin = glm::dvec3(0.0);
  for (std::size_t i = 0; i < model.positions.size(); ++i)
    model.positions[i] = float(std::pow(10.0, -double(i % 40))) * glm::vec3(random.direction());
  for (std::size_t face = 0; face < model.faces(); face += 7)  // some with all corners at the eye
    for (std::size_t corner = 0; corner < 3; ++corner)
      model.positions[3 * face + corner] = glm::vec3(0.0f);
  const std::vector<std::uint8_t> reaching = reaching_near_zone(model, cameras, 1.0);
  for (std::size_t face = 0; face < model.faces(); face += 7) EXPECT_TRUE(reaching[face]) << face;
}

TEST(NearZone, IsEmptyAsFarAsPointsTell) {
  Dataset dataset;  // five cameras at the same position, looking along -z
  for (int i = 0; i < 5; ++i)
    dataset.train.push_back({.camera = test::axis_camera(100, 80, 50), .image = {}});
  Config config;
  config.near = 1.5f;
  config.clear_near = true;
  const Region before{{0, 0, -4}, 3.0}, behind{{0, 0, 4}, 3.0};
  // Half the distance of the centre. If the centre is behind the cameras, there is no estimate.
  EXPECT_EQ(with_empty_near_zone(config, dataset, before).near, 1.5f);
  config.near = 2.5f;
  EXPECT_EQ(with_empty_near_zone(config, dataset, before).near, 2.0f);
  EXPECT_TRUE(with_empty_near_zone(config, dataset, before).clear_near);
  EXPECT_FLOAT_EQ(with_empty_near_zone(config, dataset, behind).near, 0.02f);
  EXPECT_FALSE(with_empty_near_zone(config, dataset, behind).clear_near);
  // Points in the image: at 3 and beyond, except one of a thousand. Points beside the image do not
  // count.
  dataset.points.push_back({.position = {0, 0, -0.1}, .color = {}});
  for (int i = 0; i < 999; ++i)
    dataset.points.push_back({.position = {0, 0.001 * i, -3.0 - 0.001 * i}, .color = {}});
  for (int i = 0; i < 50; ++i) dataset.points.push_back({.position = {9, 0, -0.2}, .color = {}});
  EXPECT_NEAR(with_empty_near_zone(config, dataset, behind).near, 1.5, 0.01);
  EXPECT_TRUE(with_empty_near_zone(config, dataset, behind).clear_near);
  config.clear_near = false;
  EXPECT_EQ(with_empty_near_zone(config, dataset, before).near, 2.5f);
}

}  // namespace near_zone_test

}  // namespace tureen::trainer
