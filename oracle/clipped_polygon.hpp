// A triangle in homogeneous pixels, clipped to what lies in front of the near plane and beside the
// image: what GL hands to its rasteriser.
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
/// leaves this to the implementation. Corners that the cut makes are snapped too and move its
/// edges: on 360 random soups with corners far outside, cutting at the border as llvmpipe does
/// leaves 10 pixels that disagree with it and are no depth ties, cutting 16,384 pixels further out
/// 319.
inline constexpr double guard_band = 0.0;

ClippedPolygon clip_triangle(const std::array<glm::dvec3, 3>& points, double near, int width,
                             int height);

}  // namespace tureen::oracle
