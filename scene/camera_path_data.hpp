// A camera path as it is stored: cameras with times. What lies between them is the runtime's
// (camera/camera_path.hpp).
#pragma once

#include <vector>

#include "scene/camera.hpp"

namespace tureen {

struct CameraKeyframe {
  Camera camera;
  double seconds = 0;  // finite; from the beginning of the path
  /// How far before the eye lies what the camera is about; 0: unknown.
  double target_distance = 0;
};

struct CameraPathData {
  /// Times do not decrease. Two of the same time are a cut.
  std::vector<CameraKeyframe> keyframes = {};
  /// Above 0 the path is a loop: so many seconds after the first keyframe that one comes again.
  double loop_seconds = 0;
};

}  // namespace tureen
