// The camera as seen from one layer of splats, in double precision, and boxes in its image.
//
// View coordinates here are those of the image: x points right, y down, z forward along the viewing
// axis, so z is the depth in world units. Image points are in pixels from the top left corner.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "oracle/clipped_polygon.hpp"
#include "scene/camera.hpp"

namespace tureen::oracle {

/// Rules that the methods' mathematics does not have, but their authors' code
/// (oracle/published_culls.hpp).
enum class SplatCulls { none, published };

class SplatView {
 public:
  /// `world_from_layer` is a similarity that may mirror. `near` is the frame's near distance in
  /// world units: only points with a depth of at least `near` exist.
  /// `whole`: the camera of the whole image, if `camera` is that of a part.
  SplatView(const glm::dmat4& world_from_layer, const Camera& camera, double near,
            SplatCulls culls = SplatCulls::none, const std::optional<Camera>& whole = {});

  /// A point in layer coordinates. It is computed relative to the eye, so it loses no digits far
  /// from the world's origin.
  glm::dvec3 point(const glm::dvec3& in_layer) const;
  /// A difference of two points in layer coordinates.
  glm::dvec3 direction(const glm::dvec3& in_layer) const;
  /// The inverse of direction().
  glm::dvec3 direction_in_layer(const glm::dvec3& in_view) const;
  /// The eye in layer coordinates.
  const glm::dvec3& eye() const { return eye_; }
  /// World units per layer unit.
  double scale() const;

  /// The direction through an image point. Its z is 1, so its multiple by a depth is the point at
  /// this depth.
  glm::dvec3 ray(const glm::dvec2& pixel) const {
    return {(pixel.x - camera_.cx) / camera_.fx, (pixel.y - camera_.cy) / camera_.fy, 1.0};
  }
  /// The image of a point with positive depth.
  glm::dvec2 image(const glm::dvec3& in_view) const {
    return {camera_.fx * in_view.x / in_view.z + camera_.cx,
            camera_.fy * in_view.y / in_view.z + camera_.cy};
  }

  const Camera& camera() const { return camera_; }
  const Camera& whole() const { return whole_; }
  double near() const { return near_; }
  SplatCulls culls() const { return culls_; }

 private:
  Camera camera_, whole_;
  double near_;
  SplatCulls culls_;
  glm::dmat3 view_from_world_;
  glm::dmat3 world_from_layer_;
  glm::dmat3 layer_from_world_;
  glm::dvec3 eye_to_origin_;  // the layer's origin as seen from the eye, in world axes
  glm::dvec3 eye_;
};

/// A box in the image. `low` > `high` if it is empty.
struct ImageBox {
  glm::dvec2 low{1.0};
  glm::dvec2 high{0.0};

  bool empty() const { return !(low.x <= high.x && low.y <= high.y); }
  void add(const ImageBox& other);
};

/// The box around a point, widened by `extent` to each side.
ImageBox box_around(const glm::dvec2& point, const glm::dvec2& extent);

/// The box around the visible part of a triangle in view coordinates: beyond the near plane and
/// inside the image.
ImageBox box_around_triangle(const SplatView& view, const glm::dvec3& a, const glm::dvec3& b,
                             const glm::dvec3& c);

}  // namespace tureen::oracle
