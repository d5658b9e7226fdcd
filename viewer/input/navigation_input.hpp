// Converts drags, wheel and keys to camera motion. camera/camera_controls.hpp computes the motion.
#pragma once

#include <array>
#include <glm/vec2.hpp>

#include "camera/camera_controls.hpp"
#include "viewer/input/event.hpp"

namespace tureen::viewer {

class NavigationInput {
 public:
  /// Whether the interface uses the events. A drag belongs to the part in which it began.
  struct Taken {
    bool pointer = false;
    bool keys = false;
  };

  /// Must be called for all events, in order.
  void handle(const Event& event, Taken taken, CameraControls& controls);

  /// The flight by the held keys.
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
