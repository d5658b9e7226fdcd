// Intersections of camera rays with the triangles of a soup, in double precision: all hits along
// every ray. This is geometry only; oracle/shade.hpp computes the appearance of a hit.
//
// One ray passes through each pixel centre (column + 1/2, row + 1/2), rows counted from the top.
// Let v_k = (x_k, y_k, w_k) be the homogeneous image points in pixels and p = (column + 1/2, row +
// 1/2, 1). E_k = p . (v_i x v_j) is the edge opposite vertex k and b_k = E_k / sum E the
// perspective-correct barycentric. The depth is w = det(v_0 v_1 v_2) / sum E. This needs no
// division by a w near zero, and no clipping except w >= near (docs/numerics.md, G4).
#pragma once

#include <cstdint>
#include <functional>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "scene/camera.hpp"
#include "scene/clip_range.hpp"
#include "scene/triangle_soup.hpp"

namespace tureen::oracle {

/// The pixels that a triangle covers.
enum class Coverage {
  /// The unmodified triangle. A pixel centre exactly on an edge belongs to the face to the right
  /// of the edge. If the edge is horizontal, it belongs to the face below. Faces that share an edge
  /// thus cover each centre on it once.
  exact,
  /// GL rasterisation: vertices rounded to a sub-pixel grid (RayOptions), integer edge functions. A
  /// centre on an edge belongs to the face to the right of the edge. If the edge is horizontal, it
  /// belongs to the face that snapped_upper_edge_owns selects.
  snapped,
};

/// Coverage::snapped: which of two faces owns the centres on their common horizontal edge. True:
/// the lower face, whose upper edge this is. False: the upper face. GL leaves it open. Mesa's
/// llvmpipe applies the top-left rule to rows in memory order, and a framebuffer object's first row
/// is the bottom of the image. The face above is therefore the owner
/// (GlOracleSingle.CentresOnEdgesHaveTheSameOwner).
inline constexpr bool snapped_upper_edge_owns = false;

/// The source of a snapped triangle's barycentrics and depth. GL allows both.
enum class Attributes {
  unsnapped,  // the plane of the true triangle, as in Mesa's llvmpipe; may leave [0, 1] slightly
  snapped,    // the plane through the rounded corners; never leaves [0, 1]
};

struct RayOptions {
  Coverage coverage = Coverage::exact;
  Attributes attributes = Attributes::unsnapped;  // only where coverage is snapped
  /// Bits of the snapping grid, 2^subpixel_bits steps per pixel: the device's GL_SUBPIXEL_BITS, 1
  /// .. 16, default 8. GL guarantees at least 4; Mesa and all desktop GPUs have 8.
  int subpixel_bits = 8;
};

struct Hit {
  std::uint32_t face = 0;
  double b0 = 0, b1 = 0;  // weights of the face's vertices 0 and 1
  double depth = 0;       // along the viewing axis, world units, at least the near distance; with
                          // Coverage::snapped, slightly less at a triangle that the near plane cuts
};

/// The rays of one camera through one soup at its place in the world. Both must outlive this
/// object; the soup has no defect(), and `world_from_layer` is a similarity that may mirror. Depths
/// are in world units; eye() and to_eye() are in layer coordinates. Triangles with a non-finite
/// vertex, without area or seen edge-on have no hits. Back faces are not culled.
class Rays {
 public:
  /// `range` is the frame's range. By default, it is the range of this soup alone with reversed
  /// depth. Only `near` clips.
  Rays(const TriangleSoup& soup, const glm::dmat4& world_from_layer, const Camera& camera,
       RayOptions options = {}, const std::optional<ClipRange>& range = std::nullopt);

  using HitVisitor = std::function<void(int column, int row, const Hit&)>;

  /// All hits of the pixels in rows [first_row, end_row), face by face in increasing order.
  void visit_faces(int first_row, int end_row, const HitVisitor& visit) const;

  /// The unit direction from the surface point of a pixel to the eye, in layer coordinates.
  /// Harmonics and color MLPs are functions of this direction, so the look of a layer does not
  /// change when the layer is moved. If world_from_layer mirrors, the direction is mirrored too. It
  /// is computed from the axes of camera and layer alone, so it loses no
  /// digits far from the world's origin (docs/numerics.md, V1).
  glm::dvec3 to_eye(int column, int row) const;

  /// The eye in layer coordinates.
  glm::dvec3 eye() const;

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
  /// The linear part of world_from_layer. If it is the identity, products with it are exact: a
  /// vertex relative to the eye is then the sum of the vertex and eye_to_origin_, rounded once.
  glm::dmat3 world_from_layer_;
  glm::dmat3 layer_from_world_;            // the inverse of world_from_layer_
  glm::dvec3 eye_to_origin_;               // the layer's origin as seen from the eye, in world axes
  std::vector<std::pair<int, int>> rows_;  // for every face, [first, end); empty if not visible
};

}  // namespace tureen::oracle
