#include "runtime/clip_range.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

namespace tureen {

ClipRange clip_range(const Bounds& bounds, glm::dvec3 eye) {
  // A soup that is a single point still needs a range.
  const double radius = std::max(bounds.radius(), 1e-6);
  const double distance = glm::length(bounds.centre() - eye);
  // 5 % of slack on both sides covers rounding. From within the scene the near plane comes no
  // closer than a thousandth of its radius: 24 bits of ordinary depth then still tell apart
  // surfaces 1e-4 radii apart at the far side (specs 05, section 2).
  return {std::max(0.95 * (distance - radius), 1e-3 * radius), 1.05 * (distance + radius)};
}

}  // namespace tureen
