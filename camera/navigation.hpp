// Viewpoints: views that frame a scene, and orbits around it. Pure mathematics, shared by the
// program, the viewer and the page.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "scene/camera.hpp"
#include "scene/clip_range.hpp"
#include "scene/scene.hpp"

namespace tureen {

/// The subject of a view: a box in world coordinates and the up direction.
struct Subject {
  glm::dvec3 low{-1.0};
  glm::dvec3 high{1.0};
  glm::dvec3 up{0.0, 1.0, 0.0};  // of any length; (0, 0, 0) means y

  glm::dvec3 center() const { return 0.5 * (low + high); }
};

/// The framed_bounds() of all layers, also of invisible ones.
std::vector<LayerPlace> boxes_of(const Scene& scene);

/// The box in world coordinates around boxes_of() the scene, and its up axis. A layer without
/// triangles counts as its origin. O(data).
///
/// If most of the scene's cameras are inside the box of a layer, this box ends at the cameras'
/// region (region_of_cameras): what surrounds the cameras would hide it from an eye outside.
Subject subject_of(const Scene& scene);
/// The same for boxes that are known. O(boxes).
Subject subject_of(std::span<const LayerPlace> boxes, const glm::dvec3& up,
                   std::span<const Camera> cameras = {});

/// Whether most of the cameras are inside the world's box around this layer.
bool most_are_inside(const LayerPlace& layer, std::span<const Camera> cameras);

/// The optics of a view.
struct Lens {
  int width = 1280;
  int height = 720;
  double fov_y = 0.69813170079773183;  // the full vertical angle in radians: 40 degrees
};

/// Direction of the eye as seen from the subject, in radians. Azimuth 0 is the front: +z if y is up
/// (glTF), -y if z is up (Blender). It increases to the right as seen from the front,
/// counter-clockwise seen from above. Elevation is above the horizon.
struct Bearing {
  double azimuth = 0;
  double elevation = 0;
};

/// From the front, slightly from the right and above: shows three sides of a box.
inline constexpr Bearing three_quarter_view{0.6108652381980153, 0.3490658503988659};  // 35°, 20°

/// Elevation of an orbit, high enough to distinguish the top from the front.
inline constexpr double orbit_elevation = 0.3490658503988659;  // 20 degrees

/// The unit vector from the subject to the eye.
glm::dvec3 direction_of(const glm::dvec3& up, const Bearing& bearing);

/// Distance from the box's centre at which the whole box fits into the image in this direction,
/// with a margin of 5 % at the tightest side. At least 1e-6, even for a point.
double framing_distance(const Subject& subject, const Bearing& bearing, const Lens& lens);
/// The same for a camera with these axes (Camera::world_from_view_rotation); 0 for a point.
double framing_distance(const Subject& subject, const glm::dmat3& world_from_view,
                        const Lens& lens);

/// A camera that looks at the centre of the box and shows all of it.
Camera frame(const Subject& subject, const Bearing& bearing, const Lens& lens);

/// `count` cameras evenly around the up axis, beginning at `start`. All have the same
/// distance, the smallest at which each camera shows the whole box. The apparent size of the box
/// therefore stays constant.
std::vector<Camera> orbit(const Subject& subject, int count, const Bearing& start,
                          const Lens& lens);

}  // namespace tureen
