// The camera path that is being made: its keyframes, where it plays, and how it will be written.
#pragma once

#include <glm/vec2.hpp>
#include <string>

#include "camera/camera_path.hpp"

namespace tureen::viewer {

struct Animation {
  CameraPath path;
  bool plays = false;
  bool scrubbed = false;  // the slider is held: the image follows
  double seconds = 0;     // where it plays, from the first keyframe
  int selected = -1;      // keyframe
  std::string file;       // of the JSON
  double turn_seconds = 8;

  enum class Output { frames, mp4, webm };
  Output output = Output::frames;
  double frames_per_second = 30;
  glm::ivec2 size{1280, 720};

  /// Plays, from the beginning where it is at its end; or stops.
  void toggle();
  /// Time goes on; a path that ends stops there.
  void advance(double by);
  /// The camera of this moment. Asserts keyframes.
  Camera camera(glm::ivec2 pixels) const;
};

}  // namespace tureen::viewer
