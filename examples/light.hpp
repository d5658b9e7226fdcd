// The light: a warm window to the left, a soft sky around, and two bounces from the surfaces. All
// values are linear radiance; displayed() applies exposure and the display curve.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "examples/ray_caster.hpp"
#include "examples/surface.hpp"

namespace tureen::example {

/// The radiance of the background in a direction, including the window.
glm::dvec3 room_radiance(glm::dvec3 direction);

struct LightQuality {
  int sky_rays = 160;  // over the whole sphere
  int window_rays = 36;
};

/// Diffuse light by ray casting. Every point uses the same directions, so soft shadows are sums of
/// many sharp ones. Random directions would leave noise in the images.
class Light {
 public:
  /// Computes the radiance of each face with two bounces. `caster` and `model` must outlive this.
  Light(const Model& model, const RayCaster& caster, const LightQuality& quality = {});

  /// Irradiance / pi at a point of a surface, from the front and through a translucent surface.
  /// Times the albedo, this is the reflected radiance.
  glm::dvec3 falling(std::uint32_t surface, const SurfacePoint& at) const;

  /// The radiance that arrives at a point of a surface from a direction, for a mirror: that of the
  /// nearest face, with one colour per face, or of the background.
  glm::dvec3 mirrored(const SurfacePoint& at, glm::dvec3 direction) const;

 private:
  /// Irradiance / pi on the side of the normal.
  glm::dvec3 gather(glm::dvec3 position, glm::dvec3 normal) const;

  const Model& model_;
  const RayCaster& caster_;
  std::vector<glm::dvec3> sky_directions_, window_directions_;
  std::vector<glm::dvec3> face_radiance_;
};

/// Linear radiance to display-referred sRGB in [0, 1], with a soft shoulder.
glm::dvec3 displayed(glm::dvec3 radiance);

}  // namespace tureen::example
