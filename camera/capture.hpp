// A capture: where the recorded cameras of a scene stand, and what they look at. Views of a
// captured place go around that point, near the cameras: elsewhere, no photograph shows what is
// there. Pure mathematics, as camera/navigation.hpp.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "camera/navigation.hpp"

namespace tureen {

struct Capture {
  glm::dvec3 center{0.0};  // looked_at_point() (scene/region.hpp)
  glm::dvec3 up{0, 1, 0};  // of unit length
  double distance = 1;     // from the eyes to the centre, the median
  /// The median elevation of the eyes. The azimuth is that of their mean direction, or that of the
  /// three_quarter_view if they stand all around.
  Bearing bearing = {};
  bool is_all_around = false;  // the eyes' mean horizontal direction is shorter than a half
  double half_tangent = 1;     // of half the angle that the smaller side of an image covers; median
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

/// `count` views, evenly around the up axis. Names are "orbit 0", ..
std::vector<Camera> orbit(const Capture& capture, int count, const Lens& lens);

/// The camera that programs show first: the stored one; otherwise of the cameras that which is most
/// like view_of() their capture, or the first if there is no capture. nullopt without cameras.
std::optional<Camera> first_view_of(const std::optional<Camera>& stored,
                                    std::span<const Camera> cameras, const glm::dvec3& up);

}  // namespace tureen
