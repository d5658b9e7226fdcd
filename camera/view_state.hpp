// A view as its controls hold it: what it looks at, from how far, three angles about an up axis and
// a lens. Every camera has such a state and every state a camera, so that orbiting, flying, gliding
// and recorded cameras with a roll are one thing.
//
// With u the up axis, f the direction of azimuth 0 and s = u x f (camera/navigation.hpp):
//   backward = cos(elevation) (cos(azimuth) f + sin(azimuth) s) + sin(elevation) u
//   right    = cos(azimuth) s - sin(azimuth) f,   above = backward x right
// and the roll turns (right, above) about backward. All of it holds at the poles, too: there the
// azimuth is what turns the picture.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "camera/navigation.hpp"
#include "scene/camera.hpp"

namespace tureen {

/// The lens of a view in heights of its picture, so that it fits pictures of any size as resized()
/// (scene/camera.hpp) does.
struct ViewLens {
  double focal = 1.3737387097273113;  // fy / height; 40 degrees
  double aspect = 1;                  // fx / fy: of pixels, not of the picture
  glm::dvec2 offset{0.0};             // of the principal point from the centre, right and down

  double fov_y() const;  // the full vertical angle about the centre, radians
};

ViewLens lens_of_angle(double fov_y);
ViewLens lens_of(const Camera& camera);

/// Columns of `axes` are the camera's right, up and backward axes in world coordinates; width and
/// height are in pixels. Without a name.
Camera camera_of(const ViewLens& lens, const glm::dmat3& axes, const glm::dvec3& eye, int width,
                 int height);

struct ViewState {
  glm::dvec3 up{0, 1, 0};  // of unit length
  glm::dvec3 target{0.0};
  double distance = 1;   // > 0
  Bearing bearing = {};  // angles of the eye seen from the target; the azimuth may exceed a turn
  double roll = 0;       // radians; positive turns the camera's head to its left, the picture right
  ViewLens lens = {};
};

/// Columns are the camera's right, up and backward axes in world coordinates.
glm::dmat3 rotation_of(const ViewState& state);
glm::dvec3 eye_of(const ViewState& state);

Camera camera_of(const ViewState& state, int width, int height);

/// The state of a camera, with the target at `distance` before its eye. Where it looks along `up`
/// to 1e-9, which leaves azimuth and roll undecided, the roll is 0.
ViewState state_of(const Camera& camera, const glm::dvec3& up, double distance);

/// The same picture told by angles about another axis.
ViewState with_up(const ViewState& state, const glm::dvec3& up);

/// Moves the target so that the eye stays where `eye` is.
void place_eye(ViewState& state, const glm::dvec3& eye);

/// Whole turns are taken off azimuth and roll until they lie within half a turn of `reference`'s,
/// so that what lies between the two is the short way.
void take_short_way(ViewState& state, const ViewState& reference);

/// Which point moves evenly from one state to the next.
enum class GlideAbout { target, eye };

/// What is between two states: `part` 0 is `from`, 1 is `to`. Angles, target (or eye) and the
/// logarithms of distance and focal length change evenly. Both must have one up axis.
ViewState between(const ViewState& from, const ViewState& to, double part, GlideAbout about);

/// How far apart two states are as they show: the largest of their angles in radians, their
/// distances in logarithms, their targets and eyes in units of the distance, their lenses in
/// heights. 0 is the same picture.
double difference(const ViewState& a, const ViewState& b);

}  // namespace tureen
