// Camera controls: converts pointer, wheel and key input to a camera. One class orbits and flies;
// the viewer and the web page pass it deltas. Pure mathematics in double precision, without clock,
// events or GL.
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
// Deltas change a goal, and the shown view glides towards it: the difference falls by a factor e
// per smoothing() seconds, at any frame rate. camera() returns the shown view. With smoothing 0 the
// shown view equals the goal at once, without advance().
//
// These are ignored: non-finite numbers, negative seconds, changes that move the target beyond 1e5
// radii of the subject, and results that overflow a double. Drags are additive: splitting a drag
// into parts makes no difference.
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

/// Determines the action of a drag and of the wheel. While the view glides, the target (orbit) or
/// the eye (fly) is interpolated linearly; the other point follows from it. Both modes share one
/// state; switching the mode does not change the image.
enum class NavigationMode {
  orbit,  // about a fixed target
  fly,    // from a fixed eye
};

/// Views of the whole subject, in the order of the keys 1..9. Left and right are as seen by a
/// person in front of the subject: the eye of "left" is at that person's left hand.
enum class NamedView {
  front,
  back,
  left,
  right,
  top,
  bottom,
  three_quarter,       // from the front, slightly from the right and above
  three_quarter_left,  // slightly from the left
  three_quarter_back,  // three_quarter from the back
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

/// English name: "front", "three-quarter left".
const char* name_of(NamedView view);
/// Name for programs: "front", "three-quarter-left".
const char* key_of(NamedView view);
Bearing bearing_of(NamedView view);

/// Direction of the pressed keys, and a factor for speed().
struct Flight {
  glm::dvec3 direction{0.0};  // in the camera's axes: D is +x, E is +y, W is -z; length at most 1
  double factor = 1;          // > 0: fast_factor with Shift, slow_factor with Alt
};
inline constexpr double fast_factor = 4.0;
inline constexpr double slow_factor = 0.25;

class CameraControls {
 public:
  /// Shows the three-quarter view of the subject immediately. If the box is empty or not finite, a
  /// box of radius 1 replaces it, at the same centre if that is finite.
  explicit CameraControls(const Subject& subject = {});

  /// Image size in the unit of all deltas: pixels, or points of the window system. Default 1280 x
  /// 720. Sizes below 1 (a minimised window) are ignored. The shown view is kept; call home() and
  /// arrive() to fit the subject to another aspect ratio. The first view's camera, unmoved, is
  /// fitted again.
  void set_viewport(int width, int height);

  NavigationMode mode() const { return mode_; }
  void set_mode(NavigationMode mode) { mode_ = mode; }

  /// In orbit mode, drag() calls orbit() and wheel() calls dolly() towards the pointer. In fly
  /// mode, they call look() and scale_speed().
  void drag(double dx, double dy);
  void wheel(double steps, glm::dvec2 pointer);

  /// Orbits about the target. The scene follows the pointer: half a turn for the image's height.
  /// Positive dx is to the right, positive dy down. The up axis stays upright in the image. The
  /// elevation stops 0.1 degrees before the poles, because beyond them the scene is upside down
  /// with left and right swapped. At a pole the azimuth is undefined. At 0.1 degrees from it, the
  /// horizontal part of the line of sight is 1.7e-3. The azimuth then has 13 exact digits. A view
  /// already closer to a pole (top, bottom, a recorded one) is kept. The roll of a recorded camera
  /// falls by a factor e each time the pointer has moved roll_fade times the image's height, here
  /// and in look(). pan(), dolly() and flight keep it; frame(), look_from(), home() and set_up()
  /// reset it.
  void orbit(double dx, double dy);
  static constexpr double roll_fade = 0.15;

  /// Moves in the image plane: points at the target's depth follow the pointer exactly.
  void pan(double dx, double dy);

  /// Each positive step moves the eye a tenth of the distance nearer to the target; negative steps
  /// undo it. Limits of the distance: 1e-5 and 1e4 radii of the subject. `pointer` is relative to
  /// the viewport's top left corner. The point under the pointer, at the target's depth, stays
  /// under the pointer.
  void dolly(double steps);
  void dolly(double steps, glm::dvec2 pointer);

  /// Turns the view direction: a drag to the right looks to the right. The eye stays. The angles
  /// equal those of orbit() for fields of view from 40 degrees; below, they shrink in proportion.
  void look(double dx, double dy);

  /// Speed in world units a second for a Flight of factor 1. Default: a quarter of the box's
  /// diagonal.
  double speed() const { return speed_; }
  /// Multiplies the speed by 1.2 per step.
  void scale_speed(double steps);

  /// Advances time: flies, in either mode, and glides. Two calls with half the seconds equal one
  /// call. `seconds` is not limited: after a pause, the caller must exclude the pause.
  void advance(double seconds, const Flight& flight = {});

  /// Time constant of gliding in seconds, default 0.06; 0 disables gliding and arrives.
  void set_smoothing(double seconds);
  double smoothing() const { return smoothing_; }
  /// Whether the shown view differs from the goal, so that another frame is needed.
  bool moving() const { return moving_; }
  /// Shows the goal immediately.
  void arrive();

  /// The box for frame(), the views and all limits, and the up axis for reset(); the present up
  /// axis and the view are unchanged.
  void set_subject(const Subject& subject);

  /// Shows the whole box from the present direction. Keeps bearing and field of view; resets roll
  /// and principal point. The second overload frames another box than the subject's.
  void frame();
  void frame(const glm::dvec3& low, const glm::dvec3& high);

  /// Shows the whole box from the named direction. Keeps the field of view; resets roll and
  /// principal point.
  void look_from(NamedView view);
  /// The three-quarter view with a field of view of 40 degrees, as after construction.
  void home();

  /// The subject's up axis and the first view: its camera if set, whole_in() the viewport
  /// (camera/capture.hpp), otherwise home().
  void reset();
  void set_first_view(const std::optional<Camera>& camera) { first_view_ = camera; }
  /// Whether the goal is still that of reset().
  bool goes_to_first_view() const { return at_first_view_; }

  /// Makes a point of the scene the target and centres it. Its depth, and so its scale in the
  /// image, does not change. Ignored if it is not in front of the eye.
  void focus(const glm::dvec3& point);
  /// Moves the target along the line of sight to this depth; the image is unchanged. Ignored unless
  /// positive.
  void set_target_depth(double depth);

  /// Sets the up axis; its length is irrelevant and 0 is ignored. The view keeps target, distance
  /// and bearing, so the scene is seen from the same side, and the roll becomes 0.
  void set_up(const glm::dvec3& up);
  const glm::dvec3& up() const { return goal_.up; }  // of unit length

  /// Goes to a recorded camera. After arrival, camera() at its size returns that camera bit by bit,
  /// including the name; at other sizes it returns resized(). Pose, roll, focal lengths and
  /// principal point stay until an input moves the view. The next input starts from this camera
  /// without a jump. It changes only the pose or the lens, whichever it acts on. Roll decays as in
  /// orbit(). The target is the point on the line of sight nearest to the box's centre, at least a
  /// tenth of the radius in front of the eye. A camera with a size or focal length that is not
  /// positive, or with non-finite numbers, is ignored.
  void adopt(const Camera& camera);
  /// Whether the shown view is an adopted camera, unmoved.
  bool shows_adopted() const { return adopted_ && !moving_; }

  /// The full vertical angle in radians, clamped to 0.1 .. 170 degrees. Eye and target are
  /// unchanged.
  void set_fov(double fov_y);
  double fov() const { return goal_.lens.fov_y(); }

  /// The shown view as an image of any size. The vertical angle is kept; a wider image shows more
  /// at the sides. Asserts positive sizes.
  Camera camera(int width, int height) const;

  /// The shown view as a keyframe of a path that turns about the target
  /// (scene/camera_path_data.hpp).
  CameraKeyframe keyframe(int width, int height, double seconds) const {
    return {camera(width, height), seconds, shown_.distance};
  }

  /// Values of the goal.
  const glm::dvec3& target() const { return goal_.target; }
  double distance() const { return goal_.distance; }
  glm::dvec3 eye() const { return eye_of(goal_); }
  /// Half the diagonal of the subject's box.
  double radius() const { return radius_; }

 private:
  bool usable(const ViewState& next) const;
  void move_to(const ViewState& next);    // by a delta
  void travel_to(const ViewState& next);  // to a distant view; angles take the shorter way
  ViewState turned(double dx, double dy, double radians_per_pixel) const;
  void dolly_about(double steps, const glm::dvec3& fixed_ray);
  void show_box(ViewState next, const glm::dvec3& low, const glm::dvec3& high);

  void set_box(const glm::dvec3& low, const glm::dvec3& high);

  glm::dvec3 low_{-1.0}, high_{1.0};
  glm::dvec3 first_up_{0, 1, 0};  // of unit length
  double radius_ = 1;
  glm::dvec2 viewport_{1280, 720};
  NavigationMode mode_ = NavigationMode::orbit;
  ViewState goal_, shown_;  // same up axis
  bool moving_ = false;
  std::optional<Camera> adopted_;  // the exact camera at the goal
  std::optional<Camera> first_view_;
  bool at_first_view_ = false;  // the goal
  double speed_ = 0.5;
  double smoothing_ = 0.06;
};

}  // namespace tureen
