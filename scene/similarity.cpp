#include "scene/similarity.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
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

int longest_component(const glm::dvec3& v) {
  const glm::dvec3 a(std::abs(v.x), std::abs(v.y), std::abs(v.z));
  return a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
}

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

glm::dmat3 rotation_between(const glm::dvec3& from, const glm::dvec3& to) {
  const glm::dvec3 a = glm::normalize(from), b = glm::normalize(to);
  const double cosine = glm::dot(a, b);
  // Nearer to opposite directions, the axis below has lost half of its digits.
  if (cosine < -1 + 1e-8) {
    const glm::dvec3 other = std::abs(a.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 axis = glm::normalize(other - glm::dot(other, a) * a);
    return 2.0 * glm::outerProduct(axis, axis) - glm::dmat3(1.0);
  }
  // Rodrigues: R = I + [v] + [v]^2 / (1 + cosine), for v = a x b.
  const glm::dvec3 v = glm::cross(a, b);
  const glm::dmat3 cross(0, v.z, -v.y, -v.z, 0, v.x, v.y, -v.x, 0);
  return glm::dmat3(1.0) + cross + cross * cross / (1 + cosine);
}

glm::dvec3 nearest_axis(const glm::dvec3& v) {
  const int longest = longest_component(v);
  glm::dvec3 axis(0);
  axis[longest] = v[longest] < 0 ? -1 : 1;
  return axis;
}

std::string axis_name(const glm::dvec3& axis) {
  const double length = glm::length(axis);
  if (!(length > 0) || !std::isfinite(length)) return "nothing";
  const glm::dvec3 direction = axis / length, nearest = nearest_axis(direction);
  if (glm::length(direction - nearest) < 1e-6) {
    const int longest = longest_component(nearest);
    return std::string(nearest[longest] < 0 ? "-" : "") + "xyz"[longest];
  }
  return "(" + short_decimal(direction.x, 3) + ", " + short_decimal(direction.y, 3) + ", " +
         short_decimal(direction.z, 3) + ")";
}

}  // namespace tureen
