#include "oracle/splat_view.hpp"

#include <cmath>
#include <glm/common.hpp>
#include <glm/matrix.hpp>

namespace tureen::oracle {

namespace {

/// View space has y up and z backward; here y points down and z forward.
glm::dmat3 image_axes_from_world(const Camera& camera) {
  const glm::dmat3 flip(1, 0, 0, 0, -1, 0, 0, 0, -1);
  return flip * glm::dmat3(camera.view_from_world);
}

}  // namespace

SplatView::SplatView(const glm::dmat4& world_from_layer, const Camera& camera, double near,
                     SplatCulls culls, const std::optional<Camera>& whole)
    : camera_(camera),
      whole_(whole.value_or(camera)),
      near_(near),
      culls_(culls),
      view_from_world_(image_axes_from_world(camera)),
      world_from_layer_(world_from_layer),
      layer_from_world_(glm::inverse(world_from_layer_)),
      eye_to_origin_(glm::dvec3(world_from_layer[3]) - camera.eye()),
      eye_(layer_from_world_ * -eye_to_origin_) {}

glm::dvec3 SplatView::point(const glm::dvec3& in_layer) const {
  return view_from_world_ * (world_from_layer_ * in_layer + eye_to_origin_);
}

glm::dvec3 SplatView::direction(const glm::dvec3& in_layer) const {
  return view_from_world_ * (world_from_layer_ * in_layer);
}

glm::dvec3 SplatView::direction_in_layer(const glm::dvec3& in_view) const {
  // The transpose of a rotation is its inverse.
  return layer_from_world_ * (in_view * view_from_world_);
}

double SplatView::scale() const { return std::cbrt(std::abs(glm::determinant(world_from_layer_))); }

void ImageBox::add(const ImageBox& other) {
  if (other.empty()) return;
  *this = empty() ? other : ImageBox{glm::min(low, other.low), glm::max(high, other.high)};
}

ImageBox box_around(const glm::dvec2& point, const glm::dvec2& extent) {
  return {point - extent, point + extent};
}

ImageBox box_around_triangle(const SplatView& view, const glm::dvec3& a, const glm::dvec3& b,
                             const glm::dvec3& c) {
  const Camera& camera = view.camera();
  const auto homogeneous = [&](const glm::dvec3& p) {
    return glm::dvec3(camera.fx * p.x + camera.cx * p.z, camera.fy * p.y + camera.cy * p.z, p.z);
  };
  const ClippedPolygon polygon = clip_triangle({homogeneous(a), homogeneous(b), homogeneous(c)},
                                               view.near(), camera.width, camera.height);
  ImageBox box;
  for (int i = 0; i < polygon.count; ++i) {
    const glm::dvec3& corner = polygon.corners[i].point;
    box.add(box_around(glm::dvec2(corner) / corner.z, glm::dvec2(0.0)));
  }
  return box;
}

}  // namespace tureen::oracle
