#include "viewer/animation.hpp"

#include <cmath>
#include <utility>

namespace tureen::viewer {

void Animation::begin(CameraPathData data) {
  path = CameraPath(std::move(data));
  seconds = 0;
  selected = -1;
  plays = false;
}

void Animation::toggle() {
  plays = !plays && !path.empty();
  if (plays && !path.is_loop() && seconds >= path.duration()) seconds = 0;
}

void Animation::advance(double by) {
  if (!plays || path.empty()) return;
  seconds += by;
  const double duration = path.duration();
  if (path.is_loop() && duration > 0) {
    seconds = std::fmod(seconds, duration);
  } else if (seconds >= duration) {
    seconds = duration;
    plays = false;
  }
}

Camera Animation::camera(glm::ivec2 pixels) const {
  return path.at(path.begin() + seconds, pixels.x, pixels.y);
}

}  // namespace tureen::viewer
