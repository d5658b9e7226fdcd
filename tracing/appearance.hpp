// The look of a point on a face of a soup, for every appearance in scene/triangle_soup.hpp.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

#include "scene/triangle_soup.hpp"

namespace tureen::tracing {

struct FacePoint {
  std::uint32_t face = 0;
  double b0 = 0, b1 = 0;  // weights of vertices 0 and 1
};

/// In layer coordinates.
struct ViewOfPoint {
  glm::dvec3 to_eye;  // unit direction against the ray
  glm::dvec3 eye;     // RayInLayer::eye, for the harmonics of centroids and vertices
};

/// Whether the point exists by the cut-out rule of the appearance.
bool is_visible(const TriangleSoup& soup, const FacePoint& point);

/// The display-referred colour in [0, 1].
glm::dvec3 surface_color(const TriangleSoup& soup, const FacePoint& point, const ViewOfPoint& view);

}  // namespace tureen::tracing
