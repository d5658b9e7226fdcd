#include "jobs/training/training_scale.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <vector>

#include "scene/region.hpp"

namespace tureen {

namespace {

/// Five times the limit of the published methods, so that it removes nothing that a camera shows
/// from a usual distance.
constexpr double least_distance = 5 * double(published_center_depth);
/// Beyond it, steps of 32-bit floats would grow larger than in scenes of usual units.
constexpr double largest_distance = 100;
/// That of NeRF-synthetic's cameras.
constexpr double usual_distance = 4;

void scale_camera(Camera& camera, double scale) {
  for (int axis = 0; axis < 3; ++axis) camera.view_from_world[3][axis] *= scale;
}

}  // namespace

double training_scale(const Dataset& dataset) {
  const Region region = region_of_interest(dataset);
  std::vector<double> distances;
  for (const Photograph& view : dataset.train)
    distances.push_back(glm::distance(view.camera.eye(), region.center));
  const auto middle = distances.begin() + std::ptrdiff_t(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  const double distance = std::max(*middle, region.half_side);
  if (distance >= least_distance && distance <= largest_distance) return 1;
  return std::exp2(std::round(std::log2(usual_distance / distance)));
}

void scale_dataset(Dataset& dataset, double scale) {
  for (auto* views : {&dataset.train, &dataset.test})
    for (Photograph& view : *views) scale_camera(view.camera, scale);
  for (DatasetPoint& point : dataset.points) point.position *= scale;
}

Scene scaled_scene(Scene scene, double scale) {
  const glm::dmat4 matrix = glm::scale(glm::dmat4(1.0), glm::dvec3(scale));
  for (Layer& layer : scene.layers) layer.world_from_layer = matrix * layer.world_from_layer;
  for (Camera& camera : scene.cameras) scale_camera(camera, scale);
  return scene;
}

}  // namespace tureen
