// A smooth path through recorded cameras: interpolates the keyframes of a CameraPathData. Pure
// mathematics, shared by the program, the viewer and the page.
//
//   const CameraPath path(turntable({.first = controls.camera(w, h),
//                                    .distance = controls.distance(), .up = controls.up()}));
//   draw(path.at(seconds, width, height));
//
// Positions, rotations and lenses are C1 curves through the keyframes (camera/camera_spline.hpp).
// Each rotation takes the short way to the next keyframe. Focal lengths and distances are
// interpolated by their logarithms. The principal point is interpolated in units of the image
// height. If every keyframe has a target_distance, the curve passes through the targets, and the
// eye turns about them. Keyframes around one target then give arcs, and keyframes on a circle give
// that circle. Otherwise the curve passes through the eyes.
//
// Keyframes less than shortest_span apart are a cut: one curve ends at the first of them, the next
// begins at the last. Equal consecutive cameras give a pause. A single keyframe gives a fixed
// camera.
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
  /// Sorts the keyframes by time, stably. Asserts cameras with a size and a focal length, and
  /// finite times.
  explicit CameraPath(CameraPathData data);

  const CameraPathData& data() const { return data_; }
  bool empty() const { return data_.keyframes.empty(); }
  bool is_loop() const { return data_.loop_seconds > 0; }

  /// Duration in seconds: from the first keyframe to the last, or one period of a loop. 0 without
  /// keyframes. If the period of a loop is not longer than the time from its first to its last
  /// keyframe, the loop ends with a cut.
  double duration() const;
  /// The time of the first keyframe; 0 if there is none.
  double begin() const;

  /// The camera at a time on the keyframes' clock, for any image size. Before the first keyframe
  /// and after the last the path is constant; a loop repeats in both directions. NaN counts as the
  /// beginning. The name is empty. Asserts a keyframe and a size.
  Camera at(double seconds, int width, int height) const;

  /// Each of the following recomputes all curves, in time proportional to the number of keyframes.
  /// Returns the index of the added keyframe, after those of the same time.
  std::size_t add(const CameraKeyframe& keyframe);
  void replace(std::size_t index, const CameraKeyframe& keyframe);  // keeps the old keyframe's time
  void remove(std::size_t index);
  /// Moves a keyframe to another time and returns its new index.
  std::size_t move(std::size_t index, double seconds);
  /// Period of the loop in seconds; 0 ends the loop.
  void set_loop_seconds(double seconds);

  /// Keyframes closer than this time in seconds are a cut. It is far below the duration of a frame.
  static constexpr double shortest_span = 1e-4;

 private:
  /// Differences between two knots, or derivatives by time.
  struct Change {
    glm::dvec3 point{0.0};
    glm::dvec3 turn{0.0};  // a rotation vector in the camera's axes
    std::array<double, 5> values{};
  };
  /// The interpolated quantities at a keyframe.
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
  /// Seconds to the next knot; after the last knot of a loop, to the first. 0 without a next knot
  /// or at a cut.
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

/// A turn of a camera about an axis through its target.
struct Turntable {
  Camera first;
  double distance = 1;     // > 0, from the eye to the axis along the line of sight
  glm::dvec3 up{0, 1, 0};  // the axis; of any length but 0
  double seconds = 8;      // > 0, for all turns
  int turns = 1;           // not 0; negative: clockwise seen from above
  double first_seconds = 0;
};

/// A loop of eight keyframes per turn. The eye moves on the exact circle at constant speed, to
/// within 1e-12 of the distance (rounding).
CameraPathData turntable(const Turntable& options);

/// The same around a subject, beginning at `start`. The distance is the one at which every
/// direction shows the whole box with this lens.
CameraPathData turntable(const Subject& subject, const Bearing& start, const Lens& lens,
                         double seconds);

/// The frames of a path from its beginning on; `frames_per_second` > 0. A loop does not repeat its
/// first frame; other paths include their last camera.
struct FrameRate {
  double frames_per_second = 30;
  int width = 1280;
  int height = 720;
};
/// Number of frames, as a double since a long path can exceed an int.
double frame_count(const CameraPath& path, double frames_per_second);
/// Cameras of the frames, named "frame 0" and so on.
std::vector<Camera> frames(const CameraPath& path, const FrameRate& rate);

}  // namespace tureen
