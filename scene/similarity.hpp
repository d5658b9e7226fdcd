// Similarities and axes as numbers and words that a person reads and edits.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <string>

namespace tureen {

/// The transform mirrors, scales, rotates and translates, in this order.
struct Similarity {
  glm::dvec3 position{0.0};  // of the origin, in world coordinates
  /// In degrees, about the world's axes through the origin: first about x, then about y, then
  /// about z. Positive angles are counter-clockwise, seen from the positive end of the axis.
  glm::dvec3 angles{0.0};
  double scale = 1;     // > 0
  bool mirror = false;  // negates x; then the matrix has a negative determinant
};

glm::dmat4 matrix_of(const Similarity& similarity);

/// The numbers of a matrix. Asserts that Layer's defect() (scene/scene.hpp) accepts it. The angle
/// about y is in [-90, 90], the others in (-180, 180]. At 90 and -90 the axes of x and z coincide:
/// the angle about z is then arbitrary, and the angle about x matches it.
Similarity similarity_of(const glm::dmat4& matrix);

/// "at (1, 2, 3), turned by (0, 0, 30) degrees about x, y and z, 2 times as large, mirrored"; six
/// digits, and only the parts that differ from the identity, except the position. Coordinates
/// within rounding noise of 0 are printed as 0.
std::string describe(const Similarity& similarity);

/// The smallest rotation from one direction to another. Opposite directions: half a turn about the
/// x axis, or about y if they lie along x. The lengths do not matter; neither is 0.
glm::dmat3 rotation_between(const glm::dvec3& from, const glm::dvec3& to);

/// The coordinate axis that is nearest to `v`, with its sign; of equally near ones the first.
glm::dvec3 nearest_axis(const glm::dvec3& v);

/// "x", "-y"; "(0.1, 0.9, 0.4)" if the axis differs from a coordinate axis by more than 1e-6.
std::string axis_name(const glm::dvec3& axis);

}  // namespace tureen
