#include "oracle/clipped_polygon.hpp"

#include <glm/geometric.hpp>

namespace tureen::oracle {

namespace {

/// The part of a polygon with plane . point >= offset (Sutherland and Hodgman, 1974).
ClippedPolygon clipped(const ClippedPolygon& polygon, glm::dvec3 plane, double offset) {
  ClippedPolygon result;
  const auto side = [&](const PolygonCorner& c) { return glm::dot(plane, c.point) - offset; };
  for (int i = 0; i < polygon.count; ++i) {
    const PolygonCorner& here = polygon.corners[i];
    const PolygonCorner& next = polygon.corners[(i + 1) % polygon.count];
    const double a = side(here), b = side(next);
    if (a >= 0) result.corners[result.count++] = here;
    if ((a >= 0) == (b >= 0)) continue;
    // Interpolates from the kept corner to the lost one, so that both faces at a shared edge get
    // the same bits.
    const PolygonCorner& kept = a >= 0 ? here : next;
    const PolygonCorner& lost = a >= 0 ? next : here;
    const double inside = a >= 0 ? a : b, outside = a >= 0 ? b : a;
    const double t = inside / (inside - outside);
    result.corners[result.count++] = {
        kept.point + t * (lost.point - kept.point),
        kept.barycentrics + t * (lost.barycentrics - kept.barycentrics)};
  }
  return result;
}

}  // namespace

ClippedPolygon clip_triangle(const std::array<glm::dvec3, 3>& points, double near, int width,
                             int height) {
  ClippedPolygon polygon;
  polygon.count = 3;
  for (int k = 0; k < 3; ++k) {
    glm::dvec3 weights(0.0);
    weights[k] = 1.0;
    polygon.corners[k] = {points[k], weights};
  }
  struct Plane {
    glm::dvec3 normal;
    double offset;
  };
  const Plane planes[] = {
      {{0, 0, 1}, near},       {{1, 0, guard_band}, 0},           {{-1, 0, width + guard_band}, 0},
      {{0, 1, guard_band}, 0}, {{0, -1, height + guard_band}, 0},
  };
  for (const Plane& plane : planes) {
    bool cut = false;
    for (int i = 0; i < polygon.count; ++i)
      cut |= !(glm::dot(plane.normal, polygon.corners[i].point) >= plane.offset);
    if (cut) polygon = clipped(polygon, plane.normal, plane.offset);
  }
  if (polygon.count < 3) polygon.count = 0;
  return polygon;
}

}  // namespace tureen::oracle
