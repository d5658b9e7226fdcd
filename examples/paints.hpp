// What the still life is painted with: cobalt blue under white glaze, wood, lace, lemons, leaves.
// Lengths are those of the scene; strokes are wide enough to be seen in images of 400 pixels a
// side.
#pragma once

#include <cmath>

#include "examples/surface.hpp"

namespace tureen::example {

/// The measures of a turned surface: patterns keep their shape where it is wide.
struct Turned {
  double length = 1;         // of the profile
  double circumference = 1;  // where the pattern is
};

/// The distance to the nearest whole number, with its sign: in [-1/2, 1/2).
inline double wrapped(double x) { return x - std::floor(x + 0.5); }

Paint tureen_body(glm::dvec2 uv, Turned measure);
Paint tureen_lid(glm::dvec2 uv, Turned measure);
Paint tureen_foot(glm::dvec2 uv, Turned measure);
Paint tureen_knob(glm::dvec2 uv, Turned measure);
Paint tureen_handle(glm::dvec2 uv);
Paint platter(glm::dvec2 uv, Turned measure);

/// Planks along x.
Paint wood(glm::dvec3 position);

/// A round doily, v = 0 at its inner and 1 at its outer border; `width` is the ring's.
Paint lace(glm::dvec2 uv, Turned measure);

Paint lemon_skin(glm::dvec2 uv);
/// p in the unit disc.
Paint lemon_flesh(glm::dvec2 p);

/// A strip whose outline is cut: u across, v from stalk to tip; its real size comes with it.
Paint leaf(glm::dvec2 uv, glm::dvec2 size, std::uint64_t seed);
Paint petal(glm::dvec2 uv, glm::dvec2 size);
Paint blossom_heart();
Paint bark(glm::dvec2 uv);

}  // namespace tureen::example
