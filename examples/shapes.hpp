// Shapes as parametric surfaces: surfaces of revolution, tubes, strips, discs and rings. Each
// returns position(uv); d/du x d/dv points outwards.
#pragma once

#include <functional>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "examples/curve.hpp"

namespace tureen::example {

using Shape = std::function<glm::dvec3(glm::dvec2)>;

/// The position and orientation of a shape: world = centre + frame * local.
struct Placement {
  glm::dvec3 center{0.0};
  glm::dmat3 frame{1.0};
};

/// A surface of revolution about the local y axis. Points of the profile are (radius, y, 0). The
/// outside lies to the right of the profile's direction (upwards on the outer wall, inwards on
/// top). Closed in u.
Shape turned(Curve profile, Placement placement);

/// A tube along a curve; v runs along it. Closed in u.
Shape tube(Curve center_line, std::function<double(double v)> radius);

/// A strip of `width` along a curve that faces +y. Its sides are folded up by `fold` times the
/// distance from the middle. u runs across.
Shape strip(Curve middle, double width, double fold);

/// A flat disc that faces +y, with the concentric map of Shirley and Chiu (1997). A square grid
/// with n cells a side has 4 n equal edges on the rim.
Shape disc(double radius, Placement placement);

/// A flat ring that faces +y, from the inner (v = 0) to the outer radius. Closed in u.
Shape ring(double inner, double outer, Placement placement);

/// A frame whose y axis points along `axis`.
glm::dmat3 frame_along(glm::dvec3 axis);

}  // namespace tureen::example
