// The camera path of the session: keyframes, playback and output settings.
#pragma once

#include <glm/vec2.hpp>
#include <string>

#include "camera/camera_path.hpp"

namespace tureen::viewer {

struct Animation {
  CameraPath path;
  bool plays = false;
  bool scrubbed = false;  // the slider is held, and the image follows it
  double seconds = 0;     // playback time from the first keyframe
  int selected = -1;      // keyframe
  std::string file;       // path of the JSON file
  double turn_seconds = 8;

  enum class Output { frames, mp4, webm };
  Output output = Output::frames;
  double frames_per_second = 30;
  glm::ivec2 size{1280, 720};

  /// Replaces the path, at its beginning.
  void begin(CameraPathData data);
  /// Starts playback, from the beginning if it is at the end; or stops it.
  void toggle();
  /// Advances playback by seconds. A path without a loop stops at its end.
  void advance(double by);
  /// The camera at the playback time. Asserts keyframes.
  Camera camera(glm::ivec2 pixels) const;
};

}  // namespace tureen::viewer
