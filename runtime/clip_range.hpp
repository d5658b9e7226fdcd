// The depth range of a frame, chosen from the scene so that nothing is clipped and little depth
// precision is spent on empty space. The GL path and the oracle use the same one.
#pragma once

#include <glm/vec3.hpp>

#include "soup/triangle_soup.hpp"

namespace tureen {

struct ClipRange {
  double near = 0;
  double far = 0;
};

/// `eye` is relative to the soup's origin. 0 < near < far for every finite input.
ClipRange clip_range(const Bounds& bounds, glm::dvec3 eye);

}  // namespace tureen
