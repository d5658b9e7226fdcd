// Random points in and around the region of interest, for the first primitives.
#pragma once

#include <glm/vec3.hpp>

#include "scene/region.hpp"
#include "trainer/common/random.hpp"

namespace tureen::trainer {

/// Uniform in the cube of the region.
glm::dvec3 near_point(const Region& region, Random& random);

/// Outside the cube, up to `far_extent` half sides from its centre: uniform in direction and in the
/// logarithm of the distance.
glm::dvec3 far_point(const Region& region, double far_extent, Random& random);

}  // namespace tureen::trainer
