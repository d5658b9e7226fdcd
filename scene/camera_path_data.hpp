// A camera path as stored in files: cameras with times. camera/camera_path.hpp interpolates between
// them.
#pragma once

#include <vector>

#include "scene/camera.hpp"

namespace tureen {

struct CameraKeyframe {
  Camera camera;
  double seconds = 0;  // finite; from the beginning of the path
  /// Distance from the eye to the camera's target; 0: unknown.
  double target_distance = 0;
};

struct CameraPathData {
  /// Times do not decrease. Two keyframes with the same time are a cut.
  std::vector<CameraKeyframe> keyframes = {};
  /// Above 0 the path is a loop with this period: the first keyframe returns after `loop_seconds`.
  double loop_seconds = 0;
};

}  // namespace tureen
