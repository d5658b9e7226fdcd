// The light of the room: a warm window to the left, a soft sky around, and what the things
// themselves throw back. Linear radiance; exposure and display are decided in one place.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "examples/ray_caster.hpp"
#include "examples/surface.hpp"

namespace tureen::example {

/// What comes from a direction where nothing stands, window included.
glm::dvec3 room_radiance(glm::dvec3 direction);

struct LightQuality {
  int sky_rays = 160;  // over the whole sphere
  int window_rays = 36;
};

/// Diffuse light by ray casting. Every point uses the same directions: shadows are then smooth sums
/// of many sharp ones, where random directions would leave grain in the images.
class Light {
 public:
  /// Estimates what each face throws back (two bounces). `caster` and `model` must outlive it.
  Light(const Model& model, const RayCaster& caster, const LightQuality& quality = {});

  /// Irradiance / pi on a point of a surface, front light and what shines through: times the
  /// albedo it is the radiance that leaves.
  glm::dvec3 falling(std::uint32_t surface, const SurfacePoint& at) const;

  /// The radiance that a glaze at this point of a surface mirrors from a direction: the room's,
  /// or what the thing that stands in the way throws back, faces each of one colour.
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
