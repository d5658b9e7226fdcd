// A camera in homogeneous pixels (X, Y, W): the pixel is (X / W, Y / W), W the distance from the
// camera's plane, in world units. World positions and the sides of the image are linear in these
// coordinates, so edges and faces are clipped before the division.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "scene/camera.hpp"

namespace tureen::trainer {

class HomogeneousPixels {
 public:
  /// Positions are relative to `origin`, in world units. `camera` must outlive this.
  HomogeneousPixels(const Camera& camera, glm::dvec3 origin) : camera_(camera), origin_(origin) {}

  glm::dvec3 operator()(glm::vec3 position) const {
    const glm::dvec4 v = camera_.view_from_world * glm::dvec4(origin_ + glm::dvec3(position), 1.0);
    const double w = -v.z;
    return {camera_.fx * v.x + camera_.cx * w, -camera_.fy * v.y + camera_.cy * w, w};
  }

  static constexpr int sides = 4;

  /// Distance from the image's left, right, upper or lower side (0 .. 3), times W; at least 0 on
  /// the inner side. All four are at least 0 only in front of the eye: opposite sides sum to width
  /// times W and height times W.
  double from_side(int side, glm::dvec3 point) const {
    switch (side) {
      case 0:
        return point.x;
      case 1:
        return camera_.width * point.z - point.x;
      case 2:
        return point.y;
      default:
        return camera_.height * point.z - point.y;
    }
  }

 private:
  const Camera& camera_;
  glm::dvec3 origin_;
};

}  // namespace tureen::trainer
