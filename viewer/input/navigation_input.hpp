// From events to the camera: which drag, wheel and key means what. The maths is the runtime's
// (camera/camera_controls.hpp).
#pragma once

#include <array>
#include <glm/vec2.hpp>

#include "camera/camera_controls.hpp"
#include "viewer/input/event.hpp"

namespace tureen::viewer {

class NavigationInput {
 public:
  /// Which events are the interface's: a drag belongs to who had its beginning.
  struct Taken {
    bool pointer = false;
    bool keys = false;
  };

  /// Of all events, in order.
  void handle(const Event& event, Taken taken, CameraControls& controls);

  /// By the keys that are held.
  Flight flight() const;
  bool flying() const;
  bool dragging() const { return drag_ != Drag::none; }
  bool held(Key key) const { return held_[static_cast<std::size_t>(key)]; }

 private:
  enum class Drag { none, turn, pan };
  void press(const ButtonChanged& event, bool taken);
  void move(const PointerMoved& event, CameraControls& controls);
  void change(const KeyChanged& event, bool taken, CameraControls& controls);

  Drag drag_ = Drag::none;
  Button drag_button_ = Button::left;
  glm::dvec2 pointer_{0.0};
  std::array<bool, key_count> held_{};
};

}  // namespace tureen::viewer
