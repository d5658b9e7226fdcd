// A triangle in homogeneous pixels, clipped to what lies in front of the near plane and not
// absurdly far beside the image: what GL hands to its rasteriser.
#pragma once

#include <array>
#include <glm/vec3.hpp>

namespace tureen::oracle {

struct PolygonCorner {
  glm::dvec3 point;         // (x w, y w, w): pixels from the top left corner, times w
  glm::dvec3 barycentrics;  // in the triangle that was clipped
};

struct ClippedPolygon {
  /// Three corners, and one more for each of the five planes.
  std::array<PolygonCorner, 8> corners;
  int count = 0;  // 0, or 3..8
};

/// How far beside the image a corner may lie, in pixels, before the polygon is cut off there. GL
/// leaves this to the implementation. Snapped to 1/256 pixel and multiplied, such coordinates stay
/// within 64 bits; and the cut moves an edge by no more than the snap itself does.
inline constexpr double guard_band = 16384.0;

ClippedPolygon clip_triangle(const std::array<glm::dvec3, 3>& points, double near, int width,
                             int height);

}  // namespace tureen::oracle
