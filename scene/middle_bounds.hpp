// Boxes that a few stray primitives do not enlarge.
#pragma once

#include "scene/scene.hpp"

namespace tureen {

/// The box of the middle 98 % of the faces' corners along each axis, in layer coordinates, so that
/// a few distant faces do not dominate it. For soups with very few faces it returns bounds().
Bounds middle_bounds(const TriangleSoup& soup);
/// The same for the centres of splats.
Bounds middle_bounds(const Splats& splats);

/// The box that a view of splats shows: bounds() without strays, which trained splats include. A
/// stray is farther from middle_bounds() than the longest side of that box. The box ends there,
/// also if a large splat reaches farther.
Bounds framed_bounds(const Splats& splats);
/// The same for a layer; bounds() of triangles.
Bounds framed_bounds(const Layer& layer);

}  // namespace tureen
