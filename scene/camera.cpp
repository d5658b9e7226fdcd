#include "scene/camera.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace tureen {

glm::dvec3 Camera::eye() const {
  return -(world_from_view_rotation() * glm::dvec3(view_from_world[3]));
}

glm::dmat3 Camera::world_from_view_rotation() const {
  return glm::transpose(glm::dmat3(view_from_world));
}

Camera look_at(glm::dvec3 eye, glm::dvec3 target, glm::dvec3 up, double fov_y, int width,
               int height) {
  glm::dvec3 backward = eye - target;
  const double distance = glm::length(backward);
  backward = distance > 0 ? backward / distance : glm::dvec3(0, 0, 1);
  glm::dvec3 right = glm::cross(up, backward);
  // At a sine of 1e-6 the right axis still has ten correct digits; below, rounding dominates.
  if (!(glm::length(right) > 1e-6 * glm::length(up)))
    right = glm::cross(std::abs(backward.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0),
                       backward);
  right = glm::normalize(right);
  const glm::dvec3 true_up = glm::cross(backward, right);
  const glm::dmat3 rotation = glm::transpose(glm::dmat3(right, true_up, backward));

  Camera camera;
  camera.width = width;
  camera.height = height;
  camera.fx = camera.fy = 0.5 * height / std::tan(0.5 * fov_y);
  camera.cx = 0.5 * width;
  camera.cy = 0.5 * height;
  camera.view_from_world = glm::dmat4(rotation);
  camera.view_from_world[3] = glm::dvec4(-(rotation * eye), 1.0);
  return camera;
}

Camera resized(const Camera& camera, int width, int height) {
  const double scale = double(height) / camera.height;
  Camera result = camera;
  result.width = width;
  result.height = height;
  result.fx *= scale;
  result.fy *= scale;
  result.cx = 0.5 * width + (camera.cx - 0.5 * camera.width) * scale;
  result.cy *= scale;
  return result;
}

Camera resampled(const Camera& camera, int width, int height) {
  // (cx, cy) is measured from the image corner, not from a pixel centre, so it scales directly.
  const double x = double(width) / camera.width, y = double(height) / camera.height;
  Camera result = camera;
  result.width = width;
  result.height = height;
  result.fx *= x;
  result.cx *= x;
  result.fy *= y;
  result.cy *= y;
  return result;
}

bool in_image(const Camera& camera, glm::dvec3 point) {
  const glm::dvec4 v = camera.view_from_world * glm::dvec4(point, 1.0);
  if (!(v.z < 0)) return false;
  const double x = camera.cx + camera.fx * v.x / -v.z, y = camera.cy - camera.fy * v.y / -v.z;
  return x >= 0 && x <= camera.width && y >= 0 && y <= camera.height;
}

namespace {

/// The part common to both projections: x and y of NDC from the pinhole equation.
glm::dmat4 pinhole_rows(const Camera& camera) {
  glm::dmat4 clip(0.0);
  clip[0][0] = 2.0 * camera.fx / camera.width;
  clip[1][1] = 2.0 * camera.fy / camera.height;
  clip[2][0] = 1.0 - 2.0 * camera.cx / camera.width;
  clip[2][1] = 2.0 * camera.cy / camera.height - 1.0;
  clip[2][3] = -1.0;
  return clip;
}

}  // namespace

glm::dmat4 clip_from_view(const Camera& camera, double near, double far) {
  glm::dmat4 clip = pinhole_rows(camera);
  clip[2][2] = (far + near) / (near - far);
  clip[3][2] = 2.0 * far * near / (near - far);
  return clip;
}

glm::dmat4 clip_from_view_reversed(const Camera& camera, double near) {
  glm::dmat4 clip = pinhole_rows(camera);
  clip[3][2] = near;
  return clip;
}

}  // namespace tureen
