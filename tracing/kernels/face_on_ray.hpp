// Rays and faces in double precision. Compiled without the processor's fused products: the edge
// functions of the two faces at an edge are then the same number with other signs.
#pragma once

#include <cstdint>

#include "scene/triangle_soup.hpp"
#include "tracing/ray.hpp"

namespace tureen::tracing {

/// A point of a face that a ray may meet, in layer units.
struct FaceOnRay {
  double distance, b0, b1;
  bool exists;
};

/// Both orientations are met.
FaceOnRay face_on_ray(const TriangleSoup& soup, std::uint32_t face, const RayInLayer& ray);

}  // namespace tureen::tracing
