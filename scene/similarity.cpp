#include "scene/similarity.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <numbers>

#include "base/decimal_text.hpp"
#include "scene/scene.hpp"

namespace tureen {

namespace {

constexpr double radians_per_degree = std::numbers::pi / 180;

/// The rotation about an axis of the world, 0 to 2, that takes the next axis towards the one after.
glm::dmat3 rotation_about(int axis, double degrees) {
  const int next = (axis + 1) % 3, after = (axis + 2) % 3;
  const double angle = radians_per_degree * degrees;
  glm::dmat3 rotation(1.0);
  rotation[next][next] = rotation[after][after] = std::cos(angle);
  rotation[next][after] = std::sin(angle);
  rotation[after][next] = -std::sin(angle);
  return rotation;
}

}  // namespace

glm::dmat4 matrix_of(const Similarity& similarity) {
  const glm::dvec3& angles = similarity.angles;
  glm::dmat3 linear =
      rotation_about(2, angles.z) * rotation_about(1, angles.y) * rotation_about(0, angles.x);
  for (int column = 0; column < 3; ++column) linear[column] *= similarity.scale;
  if (similarity.mirror) linear[0] = -linear[0];
  glm::dmat4 matrix(linear);
  matrix[3] = glm::dvec4(similarity.position, 1.0);
  return matrix;
}

Similarity similarity_of(const glm::dmat4& matrix) {
  assert(!defect(Layer{.world_from_layer = matrix}));
  Similarity result{.position = glm::dvec3(matrix[3])};
  glm::dmat3 axes(matrix);
  // The mean length of the axes: the determinant of a tiny or huge matrix is no double.
  result.scale = (glm::length(axes[0]) + glm::length(axes[1]) + glm::length(axes[2])) / 3;
  for (int column = 0; column < 3; ++column) axes[column] /= result.scale;
  result.mirror = glm::determinant(axes) < 0;
  if (result.mirror) axes[0] = -axes[0];
  const double z = std::atan2(axes[0].y, axes[0].x);
  const double y = std::atan2(-axes[0].z, std::hypot(axes[0].x, axes[0].y));
  // With the rotation about z undone. So x is right also where z is arbitrary.
  const double c = std::cos(z), s = std::sin(z);
  const double x = std::atan2(s * axes[2].x - c * axes[2].y, c * axes[1].y - s * axes[1].x);
  result.angles = glm::dvec3(x, y, z) / radians_per_degree + 0.0;  // without -0
  return result;
}

namespace {

std::string text_of(const glm::dvec3& v) {
  return "(" + short_decimal(v.x, 6) + ", " + short_decimal(v.y, 6) + ", " + short_decimal(v.z, 6) +
         ")";
}

}  // namespace

std::string describe(const Similarity& similarity) {
  // A coordinate that ought to be 0 has the rounding errors of the terms that cancelled: 2^-53 of
  // their size, which is that of the largest coordinate or of the scale. 1e-14 is 90 such errors,
  // more than a product of several matrices accumulates.
  glm::dvec3 position = similarity.position;
  double size = similarity.scale;
  for (int i = 0; i < 3; ++i) size = std::max(size, std::abs(position[i]));
  for (int i = 0; i < 3; ++i)
    if (std::abs(position[i]) < 1e-14 * size) position[i] = 0;
  std::string text = "at " + text_of(position);
  // Smaller differences come from rounding.
  glm::dvec3 angles = similarity.angles;
  for (int i = 0; i < 3; ++i)
    if (std::abs(angles[i]) < 1e-4) angles[i] = 0;
  if (angles != glm::dvec3(0.0))
    text += ", turned by " + text_of(angles) + " degrees about x, y and z";
  if (std::abs(similarity.scale - 1.0) > 1e-6)
    text += ", " + short_decimal(similarity.scale, 6) + " times as large";
  if (similarity.mirror) text += ", mirrored";
  return text;
}

}  // namespace tureen
