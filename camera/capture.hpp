// A capture: where the recorded cameras of a scene stand, and what they look at. Views of a
// captured place go around that point, near the cameras: elsewhere, no photograph shows what is
// there. Pure mathematics, as camera/navigation.hpp.
#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <span>
#include <vector>

#include "camera/angles.hpp"
#include "camera/navigation.hpp"
#include "scene/camera_path_data.hpp"

namespace tureen {

struct Capture {
  glm::dvec3 center{0.0};  // looked_at_point() (scene/region.hpp)
  glm::dvec3 up{0, 1, 0};  // of unit length
  double distance = 1;     // from the eyes to the centre, the median
  /// The median elevation of the eyes, and the middle of their azimuths; if they stand all around,
  /// the azimuth of the three_quarter_view.
  Bearing bearing = {};
  /// The eyes stand from `reach` radians to the left of the azimuth to `reach` to its right, but
  /// for a twentieth at each end. Half a turn, all around, if their mean horizontal direction is
  /// shorter than a half.
  double reach = 0.5 * full_turn;
  bool is_all_around() const { return reach == 0.5 * full_turn; }
  double half_tangent = 1;  // of half the angle that the smaller side of an image covers; median
};

/// nullopt for fewer than three cameras, and if they look at no common point.
std::optional<Capture> capture_of(std::span<const Camera> cameras, const glm::dvec3& up);

/// The capture that views of a scene go around; nullopt if they frame the whole box of its layers
/// instead, because its cameras stand around that box, outside: then it is an object, and all of it
/// is seen. `boxes`: boxes_of() the scene.
std::optional<Capture> capture_of(std::span<const Camera> cameras, const glm::dvec3& up,
                                  std::span<const LayerPlace> boxes);

/// An image of this size that shows as much around the centre as the photographs.
Lens lens_of(const Capture& capture, int width, int height);

/// A camera that looks at the centre, from the capture's distance and elevation; `turn`: radians
/// from the capture's azimuth, counter-clockwise seen from above.
Camera view_of(const Capture& capture, double turn, const Lens& lens);

/// `count` views, evenly around the up axis, or from one end of the reach to the other. Names are
/// "orbit 0", ..
std::vector<Camera> orbit(const Capture& capture, int count, const Lens& lens);

/// A loop of `seconds` (> 0) once around, or from the middle of the reach to one end, to the other,
/// and back.
CameraPathData turntable(const Capture& capture, const Lens& lens, double seconds);

/// The camera that programs show first: the stored one; otherwise the camera most like view_of()
/// their capture, or the first one if there is no capture. nullopt if there are no cameras.
std::optional<Camera> first_view_of(const std::optional<Camera>& stored,
                                    std::span<const Camera> cameras, const glm::dvec3& up);

/// The first view for an image or a window of this shape: with more at the top and at the bottom,
/// so that the camera's whole width is inside, or, if it already is, the camera itself. resized()
/// then gives it the size. All programs show it so.
Camera whole_in(const glm::dvec2& size, Camera first_view);

}  // namespace tureen
