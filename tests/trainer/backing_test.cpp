#include "trainer/diffsoup/backing.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <map>
#include <tuple>

#include "tests/support/random.hpp"
#include "trainer/diffsoup/initialise.hpp"

namespace tureen::trainer {
namespace backing_test {

Config config_with(int backing, int triangles) {
  Config config = preset(Preset::scene);
  config.backing_triangles = backing;
  config.triangles = triangles;
  return config;
}

/// Cameras that look at the origin from this distance.
Dataset ring(double distance, double fov_y) {
  test::Random random(3);
  Dataset dataset;
  for (int i = 0; i < 30; ++i)
    dataset.train.push_back(
        {.camera = look_at(distance * random.direction(), {0, 0, 0}, {0, 0, 1}, fov_y, 80, 60),
         .image = {}});
  return dataset;
}

TEST(Backing, HasAtMostAHundredthOfTheBudget) {
  EXPECT_EQ(backing_faces(config_with(80, 15000)), 80u);
  EXPECT_EQ(backing_faces(config_with(80, 7999)), 20u);
  EXPECT_EQ(backing_faces(config_with(80, 1999)), 0u);
  EXPECT_EQ(backing_faces(config_with(319, 100000)), 80u);
  EXPECT_EQ(backing_faces(config_with(320, 100000)), 320u);
  EXPECT_EQ(backing_faces(config_with(0, 15000)), 0u);
  EXPECT_EQ(backing_faces(preset(Preset::object)), 0u);
  EXPECT_EQ(backing_faces(published(Preset::scene)), 0u);
  Config from_mesh = config_with(80, 15000);
  from_mesh.initialisation = Initialisation::mesh;
  EXPECT_EQ(backing_faces(from_mesh), 0u);
}

TEST(Backing, SphereIsClosed) {
  for (const std::size_t faces : {20u, 80u, 320u}) {
    const std::vector<glm::vec3> corners = backing_sphere(faces, 7);
    ASSERT_EQ(corners.size(), 3 * faces);
    // Both faces at an edge have the same corners, bit by bit: no ray passes between them.
    std::map<std::tuple<float, float, float, float, float, float>, int> edges;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      EXPECT_NEAR(glm::length(corners[i]), 7, 1e-5);
      glm::vec3 a = corners[i], b = corners[i / 3 * 3 + (i + 1) % 3];
      const auto key = [](glm::vec3 p) { return std::tuple(p.x, p.y, p.z); };
      if (key(b) < key(a)) std::swap(a, b);
      ++edges[{a.x, a.y, a.z, b.x, b.y, b.z}];
    }
    EXPECT_EQ(edges.size(), 3 * faces / 2);
    for (const auto& [edge, count] : edges) EXPECT_EQ(count, 2);
  }
}

TEST(Backing, SurroundsCamerasAndFirstTriangles) {
  // With the narrow lens, the cameras lie far outside of what they look at.
  for (const double fov_y : {0.8, 0.02}) {
    const Dataset dataset = ring(5, fov_y);
    const Region region = region_of_interest(dataset);
    const Config config =
        with_visible_backing(scaled_to(config_with(80, 15000), region.half_side), dataset, region);
    const Model model = initial_model(dataset, config);
    ASSERT_EQ(model.faces(), std::size_t(config.initial_triangles));
    float nearest = 1e9f, farthest = 0;
    for (std::size_t i = 0; i < 3 * 80; ++i) {
      nearest = std::min(nearest, glm::length(model.positions[i]));
      farthest = std::max(farthest, glm::length(model.positions[i]));
    }
    EXPECT_NEAR(nearest, farthest, 1e-5 * farthest);
    EXPECT_GE(nearest, 1.4f * 5);
    EXPECT_LE(farthest + 5, config.far);
    for (std::size_t i = 3 * 80; i < model.positions.size(); ++i)
      ASSERT_LT(glm::length(model.positions[i]), 0.9f * nearest);
    // Opaque at first; other faces are half transparent.
    const std::size_t texels = 80 * model.texels();
    for (std::size_t i = 0; i < model.faces() * model.texels(); ++i)
      ASSERT_EQ(model.logits[i * channels + alpha_channel], i < texels ? 6.0f : 0.0f);
  }
}

TEST(Backing, LiesBeyondDistantPoints) {
  Dataset dataset = ring(5, 0.8);
  test::Random random(4);
  for (int i = 0; i < 500; ++i)
    dataset.points.push_back({.position = 60.0 * random.direction(), .color = {}});
  const Region region = region_of_interest(dataset);
  const Config config =
      with_visible_backing(scaled_to(config_with(80, 15000), region.half_side), dataset, region);
  const Model model = initial_model(dataset, config);
  // Some triangles start beside points, up to the distance of the nearest other point away.
  EXPECT_GE(glm::length(model.positions[0]), 1.5 * 60);
  EXPECT_LT(glm::length(model.positions[0]), 1.5 * 90);
}

}  // namespace backing_test
}  // namespace tureen::trainer
