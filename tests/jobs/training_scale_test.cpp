#include "jobs/training/training_scale.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

namespace tureen {
namespace training_scale_test {

/// Eight cameras on a circle around the origin, which look at it.
Dataset ring(double radius) {
  Dataset dataset;
  for (int i = 0; i < 8; ++i) {
    const glm::dvec3 eye = radius * glm::dvec3(std::cos(i), std::sin(i), 0.5);
    Photograph view;
    view.camera = look_at(eye, glm::dvec3(0), {0, 0, 1}, 0.7, 32, 32);
    dataset.train.push_back(view);
  }
  dataset.points.push_back({{0.5 * radius, 0, 0}, {}});
  return dataset;
}

TEST(TrainingScale, LeavesUsualScenesAndScalesOthersToThem) {
  for (const double radius : {1.5, 4.0, 80.0}) EXPECT_EQ(training_scale(ring(radius)), 1);
  for (const double radius : {0.01, 0.08, 4000.0}) {
    Dataset dataset = ring(radius);
    const glm::dvec3 eye = dataset.train[3].camera.eye();
    const double scale = training_scale(dataset);
    scale_dataset(dataset, scale);
    EXPECT_EQ(training_scale(dataset), 1);
    EXPECT_LT(glm::distance(dataset.train[3].camera.eye(), scale * eye), 1e-9);
    EXPECT_EQ(dataset.points[0].position.x, 0.5 * radius * scale);
    Scene scene;
    scene.layers.emplace_back();
    scene.cameras.push_back(dataset.train[3].camera);
    const Scene back = scaled_scene(scene, 1 / scale);
    EXPECT_EQ(back.layers[0].world_from_layer[1][1], 1 / scale);
    EXPECT_LT(glm::distance(back.cameras[0].eye(), eye), 1e-9 * radius);
  }
}

}  // namespace training_scale_test
}  // namespace tureen
