// Where the rays of a camera's pixels meet a soup's triangles, in double precision: all hits along
// every ray, in order. Geometry alone; what a hit looks like is oracle/shade.hpp's.
//
// One ray goes through each pixel centre (column + 1/2, row + 1/2), rows counted from the top. With
// the homogeneous image points v_k = (x_k, y_k, w_k) in pixels and p = (column + 1/2, row + 1/2,
// 1), E_k = p . (v_i x v_j) is the edge opposite vertex k, b_k = E_k / sum E the
// perspective-correct barycentric and w = det(v_0 v_1 v_2) / sum E the depth: no division by a w
// that may be zero, and no clipping beyond w >= near (docs/numerics.md, G4).
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <utility>
#include <vector>

#include "scene/camera.hpp"
#include "scene/clip_range.hpp"
#include "scene/triangle_soup.hpp"

namespace tureen::oracle {

/// Which pixels a triangle covers.
enum class Coverage {
  /// The triangle as it is. A centre exactly on an edge belongs to the face on its right, or below
  /// a horizontal edge, so that faces that share an edge cover every centre on it once.
  exact,
  /// As GL rasterises: vertices rounded to a grid within pixels (RayOptions), integer edge
  /// functions; a centre on an edge
  /// belongs to the face on its right, or to that which snapped_upper_edge_owns says.
  snapped,
};

/// Which of two faces owns the centres on a horizontal edge between them, when snapped: the lower
/// one, whose upper edge it is, or the upper one. GL leaves it open. Mesa's llvmpipe applies the
/// top-left rule to rows as they lie in memory, and a framebuffer object's first row is the
/// picture's bottom: so the face above owns them (GlOracleSingle.CentresOnEdgesHaveTheSameOwner).
inline constexpr bool snapped_upper_edge_owns = false;

/// Where a snapped triangle's barycentrics and depth come from. Both are within what GL allows.
enum class Attributes {
  unsnapped,  // the plane of the true triangle, as Mesa's llvmpipe does; may leave [0, 1] a little
  snapped,    // the plane through the rounded corners; never leaves [0, 1]
};

struct RayOptions {
  Coverage coverage = Coverage::exact;
  Attributes attributes = Attributes::unsnapped;  // only where coverage is snapped
  /// 2^subpixel_bits steps of the snapping grid a pixel: the device's GL_SUBPIXEL_BITS, 1 .. 16. GL
  /// promises at least 4; Mesa and all desktop GPUs have 8.
  int subpixel_bits = 8;
};

struct Hit {
  std::uint32_t face = 0;
  double b0 = 0, b1 = 0;  // weights of the face's vertices 0 and 1
  double depth = 0;       // along the viewing axis, world units, at least the near distance
};

/// The rays of one camera through one soup. Both must outlive it; the soup has no defect().
/// Triangles with a vertex that is not finite, and those that the camera sees edge-on or that have
/// no area, have no hits. Nothing is culled by facing.
class Rays {
 public:
  Rays(const TriangleSoup& soup, glm::dvec3 origin, const Camera& camera, RayOptions options = {});

  using HitVisitor = std::function<void(int column, int row, const Hit&)>;
  using PixelVisitor = std::function<void(int column, int row, std::span<const Hit>)>;

  /// All hits of the pixels in rows [first_row, end_row): face by face in rising order.
  void visit_faces(int first_row, int end_row, const HitVisitor& visit) const;

  /// For every pixel that anything hits, row by row from the top: its hits sorted by depth, ties
  /// by face. Works in bands of rows: memory is that of the hits in one band.
  void visit_pixels(const PixelVisitor& visit) const;

  /// The unit direction from a pixel's surface to the eye, from the camera's basis alone, so that
  /// it does not lose digits far from the world's origin (docs/numerics.md, V1).
  glm::dvec3 to_eye(int column, int row) const;

  const ClipRange& range() const { return range_; }

 private:
  struct Face;  // one triangle in homogeneous pixels

  bool project(std::uint32_t face, Face& out) const;
  void visit_exact(const Face& face, int first_row, int end_row, const HitVisitor& visit) const;
  void visit_snapped(const Face& face, int first_row, int end_row, const HitVisitor& visit) const;

  const TriangleSoup& soup_;
  const Camera& camera_;
  RayOptions options_;
  ClipRange range_;
  glm::dmat3 view_from_world_;
  glm::dvec3 eye_to_origin_;               // the soup's origin as seen from the eye, in world axes
  std::vector<std::pair<int, int>> rows_;  // of every face, [first, end); empty where unseen
};

}  // namespace tureen::oracle
