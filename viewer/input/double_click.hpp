// Recognises double clicks on the image.
#pragma once

#include <cmath>

#include "viewer/input/event.hpp"

namespace tureen::viewer {

class DoubleClick {
 public:
  /// Must be called for all events, in order. Returns whether the event is the second press of a
  /// double click at place(). `taken`: the interface uses the pointer. `now` is in seconds.
  bool handle(const Event& event, bool taken, double now) {
    if (const auto* to = std::get_if<PointerMoved>(&event)) place_ = *to;
    const auto* button = std::get_if<ButtonChanged>(&event);
    if (!button || !button->down) return false;
    const bool counts = button->button == Button::left && !taken;
    const bool second = counts && now - pressed_at_ < seconds &&
                        std::hypot(place_.x - pressed_.x, place_.y - pressed_.y) < points;
    pressed_at_ = counts && !second ? now : -1;
    pressed_ = place_;
    return second;
  }
  /// In points from the upper left corner.
  const PointerMoved& place() const { return place_; }

 private:
  // As most systems have it.
  static constexpr double seconds = 0.5, points = 6;

  PointerMoved place_, pressed_;
  double pressed_at_ = -1;
};

}  // namespace tureen::viewer
