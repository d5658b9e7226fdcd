// Normals of surfaces: TriangleSoup::normals.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <vector>

namespace tureen {

/// The direction of `normal` as a unit vector; zero if it has none (zero, infinite or NaN). A unit
/// vector of floats keeps its bits.
glm::vec3 unit_or_zero(const glm::dvec3& normal);

/// Whether the length is 0, or 1 within the rounding of floats.
bool is_unit_or_zero(const glm::vec3& normal);

/// The matrix that moves normals if `linear` moves the surface: its inverse transposed, times any
/// positive number. A mirror leaves each normal on its side of the surface. Zero if `linear` is
/// singular.
glm::dmat3 normal_matrix(const glm::dmat3& linear);

/// Moves the normals of a surface that `linear` moves. They are unit_or_zero() afterwards.
void move_normals(std::vector<glm::vec3>& normals, const glm::dmat3& linear);

}  // namespace tureen
