#include "oracle/hits.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <tuple>

#include "oracle/clipped_polygon.hpp"

namespace tureen::oracle {

namespace {

/// floor(value), clamped to [low, high] before the conversion to int; NaN becomes low.
int clamped_floor(double value, int low, int high) {
  return static_cast<int>(std::min(std::max(double(low), std::floor(value)), double(high)));
}

struct Box {
  int first_column, end_column, first_row, end_row;
};

/// The pixels whose centres can lie in the polygon, plus a margin of one pixel for rounding.
Box bounding_box(const ClippedPolygon& polygon, int width, int height) {
  double low_x = width, low_y = height, high_x = 0, high_y = 0;
  for (int i = 0; i < polygon.count; ++i) {
    const glm::dvec3& p = polygon.corners[i].point;
    const double x = p.x / p.z, y = p.y / p.z;
    low_x = std::min(low_x, x);
    high_x = std::max(high_x, x);
    low_y = std::min(low_y, y);
    high_y = std::max(high_y, y);
  }
  return {clamped_floor(low_x - 1, 0, width), clamped_floor(high_x + 2, 0, width),
          clamped_floor(low_y - 1, 0, height), clamped_floor(high_y + 2, 0, height)};
}

/// a x b, computed with the operands in lexicographic order. Both faces at a shared edge thus get
/// the same line with opposite signs, bit for bit, even if the compiler fuses operations.
glm::dvec3 edge_line(const glm::dvec3& a, const glm::dvec3& b) {
  return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z) ? glm::cross(a, b) : -glm::cross(b, a);
}

struct SnappedCorner {
  std::int64_t x, y;  // steps of the grid, from the top left corner
};

/// An integer edge function that is positive inside.
struct SnappedEdge {
  std::int64_t ax, ay, dx, dy;
  bool owns;

  /// `sign`: sign of the triangle's area; it makes the inside positive.
  SnappedEdge(SnappedCorner a, SnappedCorner b, int sign)
      : ax(a.x), ay(a.y), dx(sign * (b.x - a.x)), dy(sign * (b.y - a.y)) {
    // The gradient (-dy, dx) points inside: right from a left edge, down from an upper edge.
    owns = -dy > 0 || (dy == 0 && (snapped_upper_edge_owns ? dx > 0 : dx < 0));
  }
  std::int64_t at(std::int64_t x, std::int64_t y) const { return dx * (y - ay) - dy * (x - ax); }
  bool covers(std::int64_t value) const { return value > 0 || (value == 0 && owns); }
};

SnappedCorner snapped(const glm::dvec3& point, std::int64_t subpixels) {
  // Rounded in GL's window space, where y points up. A half is rounded up there, so the row is
  // rounded down here.
  return {std::int64_t(std::floor(point.x / point.z * double(subpixels) + 0.5)),
          std::int64_t(std::ceil(point.y / point.z * double(subpixels) - 0.5))};
}

}  // namespace

struct Rays::Face {
  std::uint32_t index = 0;
  std::array<glm::dvec3, 3> points;  // (x w, y w, w)
  std::array<glm::dvec3, 3> edges;   // edges[k] . (x, y, 1) = E_k
  double determinant = 0;
  ClippedPolygon polygon;
  Box box{};

  /// The hit on the plane of the unsnapped triangle at a pixel centre.
  Hit hit(double x, double y) const {
    const double e0 = edges[0].x * x + (edges[0].y * y + edges[0].z);
    const double e1 = edges[1].x * x + (edges[1].y * y + edges[1].z);
    const double e2 = edges[2].x * x + (edges[2].y * y + edges[2].z);
    const double sum = e0 + e1 + e2;
    return {index, e0 / sum, e1 / sum, determinant / sum};
  }
};

Rays::Rays(const TriangleSoup& soup, const glm::dmat4& world_from_layer, const Camera& camera,
           RayOptions options, const std::optional<ClipRange>& range)
    : soup_(soup),
      camera_(camera),
      options_(options),
      view_from_world_(camera.view_from_world),
      world_from_layer_(world_from_layer),
      layer_from_world_(glm::inverse(world_from_layer_)),
      eye_to_origin_(glm::dvec3(world_from_layer[3]) - camera.eye()) {
  assert(glm::determinant(world_from_layer_) != 0);
  if (range) {
    range_ = *range;
  } else {
    const LayerPlace placed{bounds(soup), world_from_layer};
    range_ = clip_range({&placed, 1}, camera, DepthStorage::reversed_float);
  }
  rows_.resize(soup.triangles.size());
  Face face;
  for (std::uint32_t t = 0; t < soup.triangles.size(); ++t)
    if (project(t, face)) rows_[t] = {face.box.first_row, face.box.end_row};
}

bool Rays::project(std::uint32_t index, Face& face) const {
  face.index = index;
  const glm::uvec3& triangle = soup_.triangles[index];
  const glm::dvec3 corner(soup_.positions[triangle[0]]);
  // Also false for non-finite vertices. Products of float differences are not exact, but corners
  // that coincide or lie on an axis-parallel line give exactly zero. Other needles with only
  // rounding as their area are too thin to contain a pixel centre.
  if (!(glm::length(glm::cross(glm::dvec3(soup_.positions[triangle[1]]) - corner,
                               glm::dvec3(soup_.positions[triangle[2]]) - corner)) > 0))
    return false;
  for (int k = 0; k < 3; ++k) {
    // Relative to the eye, because the product of the two matrices cancels digits far from the
    // world's origin.
    const glm::dvec3 view =
        view_from_world_ *
        (world_from_layer_ * glm::dvec3(soup_.positions[triangle[k]]) + eye_to_origin_);
    const double w = -view.z;
    face.points[k] = {camera_.fx * view.x + camera_.cx * w, camera_.cy * w - camera_.fy * view.y,
                      w};
    if (!std::isfinite(view.x) || !std::isfinite(view.y) || !std::isfinite(view.z)) return false;
  }
  for (int k = 0; k < 3; ++k)
    face.edges[k] = edge_line(face.points[(k + 1) % 3], face.points[(k + 2) % 3]);
  face.determinant = glm::dot(face.points[0], face.edges[0]);
  if (!std::isfinite(face.determinant) || face.determinant == 0) return false;
  face.polygon = clip_triangle(face.points, range_.near, camera_.width, camera_.height);
  if (face.polygon.count == 0) return false;
  face.box = bounding_box(face.polygon, camera_.width, camera_.height);
  return true;
}

void Rays::visit_exact(const Face& face, int first_row, int end_row,
                       const HitVisitor& visit) const {
  const double sign = face.determinant > 0 ? 1.0 : -1.0;
  std::array<glm::dvec3, 3> edges;
  std::array<bool, 3> owns;
  for (int k = 0; k < 3; ++k) {
    edges[k] = sign * face.edges[k];
    owns[k] = edges[k].x > 0 || (edges[k].x == 0 && edges[k].y > 0);
  }
  for (int row = first_row; row < end_row; ++row) {
    const double y = row + 0.5;
    const double at_zero[3] = {edges[0].y * y + edges[0].z, edges[1].y * y + edges[1].z,
                               edges[2].y * y + edges[2].z};
    for (int column = face.box.first_column; column < face.box.end_column; ++column) {
      const double x = column + 0.5;
      bool inside = true;
      for (int k = 0; k < 3 && inside; ++k) {
        const double e = edges[k].x * x + at_zero[k];
        inside = e > 0 || (e == 0 && owns[k]);
      }
      if (!inside) continue;
      const Hit hit = face.hit(x, y);
      // Rounding can leave a centre on all three edges of a needle: 0 / 0 and 1 / 0 are not hits.
      if (!(hit.depth >= range_.near && std::isfinite(hit.depth))) continue;
      visit(column, row, hit);
    }
  }
}

void Rays::visit_snapped(const Face& face, int first_row, int end_row,
                         const HitVisitor& visit) const {
  assert(options_.subpixel_bits >= 1 && options_.subpixel_bits <= 16);
  const std::int64_t subpixels = std::int64_t(1) << options_.subpixel_bits;
  for (int fan = 1; fan + 1 < face.polygon.count; ++fan) {
    const PolygonCorner* corners[3] = {&face.polygon.corners[0], &face.polygon.corners[fan],
                                       &face.polygon.corners[fan + 1]};
    SnappedCorner at[3];
    for (int k = 0; k < 3; ++k) at[k] = snapped(corners[k]->point, subpixels);
    const std::int64_t area = SnappedEdge(at[0], at[1], 1).at(at[2].x, at[2].y);
    if (area == 0) continue;
    const int sign = area > 0 ? 1 : -1;
    const SnappedEdge edges[3] = {{at[1], at[2], sign}, {at[2], at[0], sign}, {at[0], at[1], sign}};
    for (int row = first_row; row < end_row; ++row)
      for (int column = face.box.first_column; column < face.box.end_column; ++column) {
        const std::int64_t x = column * subpixels + subpixels / 2;
        const std::int64_t y = row * subpixels + subpixels / 2;
        std::int64_t e[3];
        bool inside = true;
        for (int k = 0; k < 3 && inside; ++k) inside = edges[k].covers(e[k] = edges[k].at(x, y));
        if (!inside) continue;
        Hit hit = face.hit(column + 0.5, row + 0.5);
        // A nearly edge-on triangle can end before this centre. Its own plane then has no positive
        // depth there, but the plane of the rounded corners has.
        if (options_.attributes == Attributes::snapped || !(hit.depth > 0)) {
          glm::dvec3 weights(0.0);
          double inverse_depth = 0;
          for (int k = 0; k < 3; ++k) {
            const double over_w = double(e[k]) / double(sign * area) / corners[k]->point.z;
            weights += over_w * corners[k]->barycentrics;
            inverse_depth += over_w;
          }
          hit = {face.index, weights.x / inverse_depth, weights.y / inverse_depth,
                 1.0 / inverse_depth};
        }
        visit(column, row, hit);
      }
  }
}

void Rays::visit_faces(int first_row, int end_row, const HitVisitor& visit) const {
  Face face;
  for (std::uint32_t t = 0; t < rows_.size(); ++t) {
    const int first = std::max(first_row, rows_[t].first);
    const int end = std::min(end_row, rows_[t].second);
    if (first >= end || !project(t, face)) continue;
    if (options_.coverage == Coverage::snapped)
      visit_snapped(face, first, end, visit);
    else
      visit_exact(face, first, end, visit);
  }
}

glm::dvec3 Rays::to_eye(int column, int row) const {
  const glm::dvec3 view((column + 0.5 - camera_.cx) / camera_.fx,
                        (camera_.cy - row - 0.5) / camera_.fy, -1.0);
  return glm::normalize(layer_from_world_ * (camera_.world_from_view_rotation() * -view));
}

glm::dvec3 Rays::eye() const { return layer_from_world_ * -eye_to_origin_; }

}  // namespace tureen::oracle
