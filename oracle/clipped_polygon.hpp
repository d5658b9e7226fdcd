// A triangle in homogeneous pixels, clipped to the near plane and to the image: the polygon that GL
// passes to its rasteriser.
#pragma once

#include <array>
#include <glm/vec3.hpp>

namespace tureen::oracle {

struct PolygonCorner {
  glm::dvec3 point;         // (x w, y w, w): pixels from the top left corner, times w
  glm::dvec3 barycentrics;  // in the original triangle
};

struct ClippedPolygon {
  /// Three corners, plus one for each of the five planes.
  std::array<PolygonCorner, 8> corners;
  int count = 0;  // 0, or 3..8
};

/// Distance outside the image at which the polygon is clipped, in pixels. GL leaves it to the
/// implementation. New corners from clipping are snapped and move the polygon's edges. Measured on
/// 360 random soups with corners far outside: clipping at the border, as llvmpipe does, leaves 10
/// pixels that differ from llvmpipe without a depth tie. Clipping 16,384 pixels further out leaves
/// 319.
inline constexpr double guard_band = 0.0;

ClippedPolygon clip_triangle(const std::array<glm::dvec3, 3>& points, double near, int width,
                             int height);

}  // namespace tureen::oracle
