// Splats in the coordinates of another frame: for formats and programs that hold no transform.
#pragma once

#include <glm/mat4x4.hpp>

#include "scene/splats.hpp"

namespace tureen {

/// Replaces the values of each splat by those in the coordinates into which `place`, a similarity,
/// leads: positions, sizes, rotations, the frequencies of neural densities, harmonics, and
/// SplatProfile::min_center_depth. Computed in double and rounded to float. A mirror is possible:
/// kernels are symmetric about their axes, and frequencies and harmonics are mirrored.
void move_splats(Splats& splats, const glm::dmat4& place);

}  // namespace tureen
