#include "viewer/film.hpp"

#include <cmath>

namespace tureen::viewer {

void Film::toggle() {
  plays = !plays && !path.empty();
  if (plays && !path.is_loop() && seconds >= path.duration()) seconds = 0;
}

void Film::advance(double by) {
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

Camera Film::camera(glm::ivec2 pixels) const {
  return path.at(path.begin() + seconds, pixels.x, pixels.y);
}

}  // namespace tureen::viewer
