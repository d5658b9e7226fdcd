// The paints of the still life: cobalt blue under white glaze, wood, lace, lemons, leaves. The unit
// of length is the scene's. Strokes are wide enough to be visible in images with 400 pixels a side.
#pragma once

#include <cmath>

#include "examples/surface.hpp"

namespace tureen::example {

/// The size of a surface of revolution, so that patterns are not stretched.
struct Turned {
  double length = 1;         // of the profile
  double circumference = 1;  // at the pattern
};

/// The signed distance to the nearest whole number, in [-1/2, 1/2).
inline double wrapped(double x) { return x - std::floor(x + 0.5); }

Paint tureen_body(glm::dvec2 uv, Turned measure);
Paint tureen_lid(glm::dvec2 uv, Turned measure);
Paint tureen_foot(glm::dvec2 uv, Turned measure);
Paint tureen_knob(glm::dvec2 uv, Turned measure);
Paint tureen_handle(glm::dvec2 uv);
Paint platter(glm::dvec2 uv, Turned measure);

/// Planks along x.
Paint wood(glm::dvec3 position);

/// A round doily; v is 0 at its inner border and 1 at its outer one.
Paint lace(glm::dvec2 uv, Turned measure);

Paint lemon_skin(glm::dvec2 uv);
/// p in the unit disc.
Paint lemon_flesh(glm::dvec2 p);

/// A strip whose outline is cut out; u runs across, v from stalk to tip. `size` is the strip's, in
/// scene units.
Paint leaf(glm::dvec2 uv, glm::dvec2 size, std::uint64_t seed);
Paint petal(glm::dvec2 uv, glm::dvec2 size);
Paint blossom_heart();
Paint bark(glm::dvec2 uv);

}  // namespace tureen::example
