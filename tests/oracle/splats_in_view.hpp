// Cameras and small sets of splats for the oracle's tests.
#pragma once

#include <algorithm>
#include <cassert>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>
#include <utility>
#include <vector>

#include "scene/camera.hpp"
#include "scene/scene.hpp"
#include "scene/spherical_harmonics.hpp"
#include "scene/splats.hpp"
#include "tests/support/random.hpp"

namespace tureen::test {

/// A camera at the origin that looks along -z, with the principal point at the image's centre.
inline Camera straight_camera(int width, int height, double focal_length) {
  Camera camera;
  camera.width = width;
  camera.height = height;
  camera.fx = camera.fy = focal_length;
  camera.cx = 0.5 * width;
  camera.cy = 0.5 * height;
  return camera;
}

/// The same colour from all sides.
inline SplatColor flat_colors(const std::vector<glm::vec3>& rgb) {
  SplatColor color;
  for (const glm::vec3& each : rgb)
    color.coefficients.push_back((each - 0.5f) / float(harmonics::y00));
  return color;
}

inline glm::quat random_rotation(Random& random) {
  return glm::normalize(glm::quat(float(random.normal()), float(random.normal()),
                                  float(random.normal()), float(random.normal())));
}

/// The point in front of straight_camera() that it sees at `pixel` and at this depth.
inline glm::dvec3 point_at(const Camera& camera, const glm::dvec2& pixel, double depth) {
  return {(pixel.x - camera.cx) / camera.fx * depth, (camera.cy - pixel.y) / camera.fy * depth,
          -depth};
}

inline Layer layer_of(Primitives primitives) {
  Layer layer;
  layer.primitives = std::move(primitives);
  return layer;
}

}  // namespace tureen::test
