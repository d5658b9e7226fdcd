// A session: the recorded events of a window, for replay. It is a JSON file that people can read
// and edit:
//
//   { "tureen_session": 1, "window": [960, 600],
//     "events": [ {"at": 0.0,  "await": true},
//                 {"at": 0.5,  "pointer": [480, 300]},
//                 {"at": 0.5,  "button": "left", "down": true},
//                 {"at": 0.9,  "pointer": [600, 320]},
//                 {"at": 0.9,  "button": "left", "down": false},
//                 {"at": 1.0,  "key": "F", "down": true},
//                 {"at": 1.1,  "key": "F", "down": false},
//                 {"at": 1.2,  "wheel": [0, 1]},
//                 {"at": 1.3,  "text": "7"},
//                 {"at": 1.4,  "drop": ["other.glb"]},
//                 {"at": 1.5,  "resize": [800, 600]},
//                 {"at": 1.6,  "replace": ["other.glb", "with.glb"]},
//                 {"at": 1.7,  "click": "Frame all"},
//                 {"at": 1.8,  "click": "gizmo: x", "by": [40, 0]},
//                 {"at": 2.0,  "picture": "after.png"},
//                 {"at": 2.1,  "close": true} ] }
//
// "at" is in seconds since the start of the session and never decreases. "await" stops the clock
// until nothing is being loaded and nothing moves. "picture" saves the window as a PNG in the
// folder for images (`--images`). "click" clicks the control with this name, or drags it by a
// distance; the program ends with an error if none is in sight. "replace" copies the second file
// over the first, as a running trainer does. Other relative paths start at the program's working
// folder.
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <span>
#include <string>
#include <vector>

#include "viewer/input/event.hpp"

namespace tureen::viewer {

struct Session {
  glm::ivec2 window{1280, 800};  // in points
  std::vector<TimedEvent> events;

  void add(double seconds, std::span<const Event> more);
};

/// Throws InputError with the file and the event.
Session read_session(const std::filesystem::path& file);

std::string session_to_json(const Session& session);

/// Replays a session by the session's own clock. Each frame advances the clock by 1/60 s, whatever
/// its real duration, so that a session shows the same images on every machine.
class Replay {
 public:
  explicit Replay(Session session) : session_(std::move(session)) {}

  static constexpr double frame_seconds = 1.0 / 60;

  /// The events of the next frame. `at_rest`: nothing is being loaded and nothing moves. A
  /// screenshot ends the frame's events, so that it shows all events before it.
  std::vector<Event> next(bool at_rest);
  bool finished() const { return position_ == session_.events.size(); }
  double now() const { return clock_; }

 private:
  Session session_;
  std::size_t position_ = 0;
  double clock_ = 0;
};

}  // namespace tureen::viewer
