// A smooth way through recorded cameras: what is between the keyframes of a CameraPathData. Plain
// maths, shared by the program, the window and the page.
//
//   const CameraPath path(turntable({.first = controls.camera(w, h),
//                                    .distance = controls.distance(), .up = controls.up()}));
//   draw(path.at(seconds, width, height));
//
// Positions, rotations and lenses are C1 curves through the keyframes (camera/camera_spline.hpp),
// each rotation by the short way from one keyframe to the next; focal lengths and distances change
// by factors, the principal point in heights of the picture. Where every keyframe has a
// target_distance the curve is drawn through the targets, and the eye turns about them: keyframes
// around one target give arcs about it, and keyframes on a circle give that circle. Otherwise it is
// drawn through the eyes.
//
// Keyframes less than shortest_span apart are a cut: the curve ends in the first and another begins
// with the last. Equal cameras one after the other are a pause. One keyframe is a camera that
// stays.
#pragma once

#include <array>
#include <cstddef>
#include <glm/gtc/quaternion.hpp>
#include <vector>

#include "camera/navigation.hpp"
#include "scene/camera_path_data.hpp"

namespace tureen {

class CameraPath {
 public:
  CameraPath() = default;
  /// Puts the keyframes in the order of their times; those of one time keep theirs. Asserts cameras
  /// with a size and a focal length, and finite times.
  explicit CameraPath(CameraPathData data);

  const CameraPathData& data() const { return data_; }
  bool empty() const { return data_.keyframes.empty(); }
  bool is_loop() const { return data_.loop_seconds > 0; }

  /// From the first keyframe to the last, or until the first comes again. 0 without keyframes. A
  /// loop that lasts no longer than its keyframes ends with a cut.
  double duration() const;
  /// The time of the first keyframe; 0 without any.
  double begin() const;

  /// The camera at a time of the keyframes' clock, for a picture of any size. Before the first
  /// keyframe and after the last it is theirs; a loop goes on for ever both ways. NaN is the
  /// beginning. The name is empty. Asserts a keyframe and a size.
  Camera at(double seconds, int width, int height) const;

  /// Each makes the curves anew, in a time that grows with the number of keyframes.
  /// The index of the keyframe that was added, behind those of the same time.
  std::size_t add(const CameraKeyframe& keyframe);
  void replace(std::size_t index, const CameraKeyframe& keyframe);  // keeps the time it had
  void remove(std::size_t index);
  /// To another time; the index that it has then.
  std::size_t move(std::size_t index, double seconds);
  /// 0 ends the loop.
  void set_loop_seconds(double seconds);

  /// A ten-thousandth of a second: no picture lies between.
  static constexpr double shortest_span = 1e-4;

 private:
  /// Differences between two knots, or derivatives by time.
  struct Change {
    glm::dvec3 point{0.0};
    glm::dvec3 turn{0.0};  // a rotation vector in the camera's axes
    std::array<double, 5> values{};
  };
  /// What the curves go through at a keyframe.
  struct Knot {
    double seconds = 0;
    glm::dvec3 point{0.0};            // the target, or the eye
    glm::dquat rotation{1, 0, 0, 0};  // world from view
    /// Logarithms of distance, of the focal length in heights and of fx / fy; the principal point
    /// from the centre in heights.
    std::array<double, 5> values{};
    Change rate = {};
  };

  void make_curves();
  Knot knot_of(const CameraKeyframe& keyframe) const;
  /// To the next knot, which after the last of a loop is the first; 0 where there is none, or a
  /// cut.
  double span_after(std::size_t index) const;
  std::size_t next(std::size_t index) const { return (index + 1) % knots_.size(); }
  std::size_t previous(std::size_t index) const {
    return (index + knots_.size() - 1) % knots_.size();
  }
  void take_rate(std::size_t index);
  void take_end_rate(std::size_t index);
  static Change change(const Knot& from, const Knot& to);
  static Knot between(const Knot& a, const Knot& b, double seconds, double part);

  CameraPathData data_;
  bool about_targets_ = false;
  std::vector<Knot> knots_;
};

/// A turn of a camera about an axis through what it looks at.
struct Turntable {
  Camera first;
  double distance = 1;     // > 0, from the eye to the axis along the line of sight
  glm::dvec3 up{0, 1, 0};  // the axis; of any length but 0
  double seconds = 8;      // > 0, for all turns
  int turns = 1;           // not 0; negative: clockwise seen from above
  double first_seconds = 0;
};

/// A loop of eight keyframes a turn whose eye stays on the exact circle, with one speed: to within
/// 1e-12 of its distance, which is rounding.
CameraPathData turntable(const Turntable& options);

/// The same around a subject, from `start` on, at the distance at which every direction shows the
/// whole box with this lens.
CameraPathData turntable(const Subject& subject, const Bearing& start, const Lens& lens,
                         double seconds);

/// Pictures of a path: `frames_per_second` > 0 of them from its beginning on. A loop's first does
/// not come twice; a path that ends shows its last camera, too.
struct FrameRate {
  double frames_per_second = 30;
  int width = 1280;
  int height = 720;
};
/// How many that are, as a double because a long path may have more than an int holds.
double frame_count(const CameraPath& path, double frames_per_second);
/// Their cameras, "frame 0" and so on.
std::vector<Camera> frames(const CameraPath& path, const FrameRate& rate);

}  // namespace tureen
