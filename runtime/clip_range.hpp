// The depth range of a frame, chosen from the scene so that little is clipped and little depth
// precision is spent on empty space. The oracle uses that of reversed depth.
#pragma once

#include <glm/vec3.hpp>

#include "soup/triangle_soup.hpp"

namespace tureen {

struct ClipRange {
  double near = 0;
  double far = 0;
};

/// How depth is stored decides how near the near plane may come to an eye within the scene.
enum class DepthStorage {
  fixed_24,        // precision is lost in proportion to far / near: a thousandth of the radius
  reversed_float,  // precision does not depend on the near plane: a millionth
};

/// `eye` is relative to the soup's origin. 0 < near < far for every finite input. What lies nearer
/// than `near` is clipped; seen from outside the bounds, nothing does.
ClipRange clip_range(const Bounds& bounds, glm::dvec3 eye, DepthStorage storage);

}  // namespace tureen
