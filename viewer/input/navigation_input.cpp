#include "viewer/input/navigation_input.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

namespace tureen::viewer {

namespace {

struct Push {
  Key key;
  glm::dvec3 direction;  // in the camera's axes
};

const std::array<Push, 6> pushes = {{{Key::w, {0, 0, -1.0}},
                                     {Key::s, {0, 0, 1.0}},
                                     {Key::a, {-1.0, 0, 0}},
                                     {Key::d, {1.0, 0, 0}},
                                     {Key::q, {0, -1.0, 0}},
                                     {Key::e, {0, 1.0, 0}}}};

/// A press of an arrow is a drag by this many points, about as on the page (a 60th of the height of
/// a window of 720 points).
constexpr double arrow_points = 12;

struct Arrow {
  Key key;
  glm::dvec2 drag;
};

const std::array<Arrow, 4> arrows = {{{Key::left, {-arrow_points, 0}},
                                      {Key::right, {arrow_points, 0}},
                                      {Key::up, {0, -arrow_points}},
                                      {Key::down, {0, arrow_points}}}};

bool pushes_anywhere(Key key) {
  return std::any_of(pushes.begin(), pushes.end(),
                     [key](const Push& push) { return push.key == key; });
}

}  // namespace

void NavigationInput::handle(const Event& event, Taken taken, CameraControls& controls) {
  if (const auto* button = std::get_if<ButtonChanged>(&event)) press(*button, taken.pointer);
  if (const auto* pointer = std::get_if<PointerMoved>(&event)) move(*pointer, controls);
  if (const auto* key = std::get_if<KeyChanged>(&event)) change(*key, taken.keys, controls);
  if (const auto* wheel = std::get_if<Scrolled>(&event); wheel && !taken.pointer)
    controls.wheel(wheel->away, pointer_);
  if (const auto* focus = std::get_if<FocusChanged>(&event); focus && !focus->focused) {
    held_.fill(false);  // keys released in another window are never reported
    drag_ = Drag::none;
  }
}

void NavigationInput::press(const ButtonChanged& event, bool taken) {
  if (!event.down) {
    if (event.button == drag_button_) drag_ = Drag::none;
    return;
  }
  if (taken || drag_ != Drag::none) return;
  drag_button_ = event.button;
  drag_ = event.button == Button::left && !held(Key::shift) ? Drag::turn : Drag::pan;
}

void NavigationInput::move(const PointerMoved& event, CameraControls& controls) {
  const glm::dvec2 to(event.x, event.y), way = to - pointer_;
  pointer_ = to;
  if (drag_ == Drag::turn) controls.drag(way.x, way.y);
  if (drag_ == Drag::pan) controls.pan(way.x, way.y);
}

void NavigationInput::change(const KeyChanged& event, bool taken, CameraControls& controls) {
  // Ctrl+S does not fly back, even if Ctrl is released before S.
  const bool modified = held(Key::control) || held(Key::super);
  held_[static_cast<std::size_t>(event.key)] =
      event.down && !taken && !(modified && pushes_anywhere(event.key));
  if (!event.down || taken || modified) return;
  if (pushes_anywhere(event.key)) controls.set_mode(NavigationMode::fly);
  for (const auto& [key, drag] : arrows)
    if (event.key == key)
      held(Key::shift) ? controls.pan(drag.x, drag.y) : controls.drag(drag.x, drag.y);
  if (event.key == Key::equal) controls.dolly(1);
  if (event.key == Key::minus) controls.dolly(-1);
}

Flight NavigationInput::flight() const {
  Flight flight;
  if (held(Key::control) || held(Key::super)) return flight;
  for (const Push& push : pushes)
    if (held(push.key)) flight.direction += push.direction;
  if (const double length = glm::length(flight.direction); length > 0) flight.direction /= length;
  if (held(Key::shift)) flight.factor *= fast_factor;
  if (held(Key::alt)) flight.factor *= slow_factor;
  return flight;
}

bool NavigationInput::flying() const { return flight().direction != glm::dvec3(0.0); }

}  // namespace tureen::viewer
