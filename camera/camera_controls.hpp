// What a person does with a pointer, a wheel and keys, turned into a camera: orbit and fly in one
// value, fed with deltas by the window and by the page. Plain maths in double precision; no clock,
// no events, no GL.
//
//   CameraControls controls(subject_of(scene));
//   controls.set_viewport(width, height);            // in the unit of the pointer's deltas
//   controls.orbit(dx, dy);                           // left drag
//   controls.pan(dx, dy);                             // right drag, or shift and left
//   controls.dolly(steps);                            // wheel, or dolly(steps, pointer)
//   controls.advance(seconds, {.direction = {0, 0, -1}, .factor = 4});  // W and Shift
//   draw(controls.camera(framebuffer_width, framebuffer_height));
//   if (!controls.moving() && no key is held) wait for events;
//
// The deltas act on a goal; what is shown glides towards it: the difference falls by e each
// smoothing() seconds, which is the same whatever the frame rate. camera() is what is shown. With
// smoothing 0 both are the same at once, without advance().
//
// Numbers that are not finite, and seconds below 0, are ignored, and so is what would take the
// target beyond 1e5 radii of the subject or make anything else that doubles cannot hold. A drag is
// one sum: in how many pieces it comes makes no difference.
#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "camera/navigation.hpp"
#include "camera/view_state.hpp"
#include "scene/camera.hpp"
#include "scene/camera_path_data.hpp"

namespace tureen {

/// What a drag and the wheel do, and which point moves evenly while the picture glides. Both
/// modes share one state: changing from one to the other changes no picture.
enum class NavigationMode {
  orbit,  // about a target that stays where it is
  fly,    // from an eye that stays where it is
};

/// Views of the whole subject, in the order of the keys 1..9. "left" shows the left side of who
/// stands before the front, with the eye there.
enum class NamedView {
  front,
  back,
  left,
  right,
  top,
  bottom,
  three_quarter,       // from the front, a little to the right and from above
  three_quarter_left,  // the same to the left
  three_quarter_back,  // the same from behind
};
inline constexpr std::array named_views{NamedView::front,
                                        NamedView::back,
                                        NamedView::left,
                                        NamedView::right,
                                        NamedView::top,
                                        NamedView::bottom,
                                        NamedView::three_quarter,
                                        NamedView::three_quarter_left,
                                        NamedView::three_quarter_back};

/// For people: "front", "three-quarter left".
const char* name_of(NamedView view);
/// For programs: "front", "three-quarter-left".
const char* key_of(NamedView view);
Bearing bearing_of(NamedView view);

/// Where the keys push, and how much faster than speed().
struct Flight {
  glm::dvec3 direction{0.0};  // in the camera's axes: D is +x, E is +y, W is -z; at most 1 long
  double factor = 1;          // > 0: fast_factor with Shift, slow_factor with Alt
};
inline constexpr double fast_factor = 4.0;
inline constexpr double slow_factor = 0.25;

class CameraControls {
 public:
  /// Shows the three-quarter view of the subject at once. A box that is empty or not finite is
  /// replaced by one of radius 1 (about its centre where that is finite).
  explicit CameraControls(const Subject& subject = {});

  /// The picture's size in the unit of all deltas: pixels, or a window system's points. 1280 x 720
  /// until it is called; sizes below 1 (a window that is minimised) are ignored. What is shown
  /// stays: home() and arrive() begin anew in another shape.
  void set_viewport(int width, int height);

  NavigationMode mode() const { return mode_; }
  void set_mode(NavigationMode mode) { mode_ = mode; }

  /// orbit() or look(), dolly() towards the pointer or scale_speed(), as the mode says.
  void drag(double dx, double dy);
  void wheel(double steps, glm::dvec2 pointer);

  /// About the target: the scene follows the pointer, half a turn for the picture's height. dx to
  /// the right, dy down. The up axis stays upright in the picture, and the elevation ends 0.1
  /// degrees short of the poles: past them the scene would stand on its head and left and right
  /// change places, and at them the azimuth could not be told from the line of sight (0.1 degrees
  /// away its level part is 1.7e-3 long, which keeps 13 digits of the direction). A view that is
  /// nearer to a pole already (top, bottom, a recorded one) is not pushed away.
  /// A roll that a recorded camera brought fades with the way of the pointer, by e for each
  /// roll_fade of the picture's height, here and in look(); nothing else touches it.
  void orbit(double dx, double dy);
  static constexpr double roll_fade = 0.15;

  /// Within the picture's plane: what lies at the target's depth follows the pointer exactly.
  void pan(double dx, double dy);

  /// Each step takes a tenth of the distance to the target, a negative one gives it back. Ends at
  /// 1e-5 and 1e4 radii of the subject. With a pointer, measured from the viewport's top left
  /// corner, what it shows at the target's depth stays under it.
  void dolly(double steps);
  void dolly(double steps, glm::dvec2 pointer);

  /// Turns the head: drag to the right looks to the right. The eye stays; the angles are orbit()'s,
  /// smaller where the lens is narrower than 40 degrees.
  void look(double dx, double dy);

  /// World units a second of a Flight of factor 1. A quarter of the box's diagonal at first.
  double speed() const { return speed_; }
  /// Each step 1.2 times the speed.
  void scale_speed(double steps);

  /// Lets time pass: flies, in either mode, and glides. Two calls of half the seconds do the same
  /// as one. Any span is obeyed, so a caller that was asleep for ten seconds while a key was held
  /// passes what it wants flown.
  void advance(double seconds, const Flight& flight = {});

  /// The time constant of gliding, 0.06 s at first; 0 switches it off and arrives.
  void set_smoothing(double seconds);
  double smoothing() const { return smoothing_; }
  /// Whether what is shown is not yet the goal, so that another frame is needed.
  bool moving() const { return moving_; }
  /// Shows the goal.
  void arrive();

  /// The box that frame(), the views and all limits mean, without its up axis; moves nothing.
  void set_box(const glm::dvec3& low, const glm::dvec3& high);

  /// All of the box from where the eye is: keeps bearing and angle of view; takes away roll and
  /// shifted principal point. The second shows another box than the subject's.
  void frame();
  void frame(const glm::dvec3& low, const glm::dvec3& high);

  /// All of the box from there, likewise.
  void look_from(NamedView view);
  /// The three-quarter view with an angle of 40 degrees: where the constructor began.
  void home();

  /// The first view: that camera where one was set, home() otherwise.
  void reset();
  void set_first_view(const std::optional<Camera>& camera) { first_view_ = camera; }

  /// A point of the scene becomes the target and comes to the picture's centre, as large as it
  /// was. Ignored where it is not before the eye.
  void focus(const glm::dvec3& point);
  /// The target moves along the line of sight to that depth; the picture stays. Ignored where it
  /// is not positive.
  void set_target_depth(double depth);

  /// Another axis is up (its length does not matter; 0 is ignored). The view keeps target,
  /// distance and bearing, so that the scene gets up and is seen from the same side as before, and
  /// is level.
  void set_up(const glm::dvec3& up);
  const glm::dvec3& up() const { return goal_.up; }  // of unit length

  /// Goes to a recorded camera. Once arrived, camera() of its size is that camera bit by bit, name
  /// and all, and of other sizes resized(); pose, roll, focal lengths and principal point stay
  /// until something moves the view, which begins from there without a jump: pose and lens change
  /// only by what is asked, and the roll fades as orbit() says. The target lies where the line of
  /// sight passes the box's centre, at least a tenth of the radius away. A camera with a size or a
  /// focal length that is not positive, or with numbers that are not finite, is ignored.
  void adopt(const Camera& camera);
  /// Whether what is shown is an adopted camera that was not moved.
  bool shows_adopted() const { return adopted_ && !moving_; }

  /// The full vertical angle, radians; clamped to 0.1 .. 170 degrees. Eye and target stay.
  void set_fov(double fov_y);
  double fov() const { return goal_.lens.fov_y(); }

  /// What is shown, as a picture of any size: the vertical angle stays and a wider picture shows
  /// more at the sides. Asserts positive sizes.
  Camera camera(int width, int height) const;

  /// What is shown, as a keyframe of a path that turns about the target
  /// (scene/camera_path_data.hpp).
  CameraKeyframe keyframe(int width, int height, double seconds) const {
    return {camera(width, height), seconds, shown_.distance};
  }

  /// Of the goal.
  const glm::dvec3& target() const { return goal_.target; }
  double distance() const { return goal_.distance; }
  glm::dvec3 eye() const { return eye_of(goal_); }
  /// Half the diagonal of the subject's box.
  double radius() const { return radius_; }

 private:
  bool usable(const ViewState& next) const;
  void move_to(const ViewState& next);    // by a delta
  void travel_to(const ViewState& next);  // by a leap, the short way
  ViewState turned(double dx, double dy, double radians_per_pixel) const;
  void dolly_about(double steps, const glm::dvec3& fixed_ray);
  void show_box(ViewState next, const glm::dvec3& low, const glm::dvec3& high);

  glm::dvec3 low_{-1.0}, high_{1.0};
  double radius_ = 1;
  glm::dvec2 viewport_{1280, 720};
  NavigationMode mode_ = NavigationMode::orbit;
  ViewState goal_, shown_;  // of one up axis
  bool moving_ = false;
  std::optional<Camera> adopted_;  // the goal's very camera
  std::optional<Camera> first_view_;
  double speed_ = 0.5;
  double smoothing_ = 0.06;
};

}  // namespace tureen
