// A view as the controls store it: a target, a distance, three angles about an up axis and a lens.
// A state gives a camera; a camera, a target distance and an up axis give a state. One
// representation thus serves orbiting, flying, gliding and recorded cameras with a roll.
//
// With u the up axis, f the direction of azimuth 0 and s = u x f (camera/navigation.hpp):
//   backward = cos(elevation) (cos(azimuth) f + sin(azimuth) s) + sin(elevation) u
//   right    = cos(azimuth) s - sin(azimuth) f,   above = backward x right
// The roll turns (right, above) about backward. The formulas also hold at the poles, where the
// azimuth turns the image.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "camera/navigation.hpp"
#include "scene/camera.hpp"

namespace tureen {

/// The lens of a view, independent of the image size: lengths are fractions of the image height.
struct ViewLens {
  double focal = 1.3737387097273113;  // fy / height; default: fov_y() is 40 degrees
  double aspect = 1;                  // fx / fy: height over width of a pixel
  /// From the image centre to the principal point, right and down, in image heights.
  glm::dvec2 offset{0.0};

  double fov_y() const;  // full vertical angle in radians, without the offset
};

ViewLens lens_of_angle(double fov_y);
ViewLens lens_of(const Camera& camera);

/// A camera without a name. Columns of `axes` are the camera's right, up and backward axes in world
/// coordinates; width and height are in pixels.
Camera camera_of(const ViewLens& lens, const glm::dmat3& axes, const glm::dvec3& eye, int width,
                 int height);

struct ViewState {
  glm::dvec3 up{0, 1, 0};  // of unit length
  glm::dvec3 target{0.0};
  double distance = 1;   // > 0
  Bearing bearing = {};  // of the eye seen from the target; the azimuth may exceed a turn
  double roll =
      0;  // radians; if positive, the camera tilts to its left and the image turns clockwise
  ViewLens lens = {};
};

/// Columns are the camera's right, up and backward axes in world coordinates.
glm::dmat3 rotation_of(const ViewState& state);
glm::dvec3 eye_of(const ViewState& state);

Camera camera_of(const ViewState& state, int width, int height);

/// The state of a camera, with the target at `distance` in front of its eye. If it looks along `up`
/// to within 1e-9, azimuth and roll are ambiguous and the roll is 0.
ViewState state_of(const Camera& camera, const glm::dvec3& up, double distance);

/// The same view, with angles about another axis.
ViewState with_up(const ViewState& state, const glm::dvec3& up);

/// Moves the target so that the eye comes to `eye`.
void place_eye(ViewState& state, const glm::dvec3& eye);

/// Shifts azimuth and roll by whole turns to within half a turn of those of `reference`.
/// Interpolation between the two then takes the short way.
void take_short_way(ViewState& state, const ViewState& reference);

/// The point that is interpolated linearly between two states.
enum class GlideAbout { target, eye };

/// Interpolates two states: `part` 0 is `from`, 1 is `to`. Angles, target (or eye) and the
/// logarithms of distance and focal length are interpolated linearly. Both must have the same up
/// axis.
ViewState between(const ViewState& from, const ViewState& to, double part, GlideAbout about);

/// Visible difference of two states: the largest difference of angles in radians, distances in
/// logarithms, targets and eyes in units of the distance, and lenses in image heights. 0 means the
/// same image.
double difference(const ViewState& a, const ViewState& b);

}  // namespace tureen
