// The table of keys: the action of each and its text in the list of keys.
#pragma once

#include <span>

#include "viewer/input/event.hpp"
#include "viewer/state.hpp"

namespace tureen::viewer {

/// The keys that are held. Without Ctrl, Shift changes nothing.
enum class With { nothing, control, control_shift };

struct Shortcut {
  Key key;
  With with;
  const char* group;  // of the list of keys
  const char* text;   // null if another row of the list has the key
  void (*run)(State& state);
};

std::span<const Shortcut> shortcuts();

/// Runs the action of the key. Returns whether it has one.
bool run_shortcut(Key key, With with, State& state);

}  // namespace tureen::viewer
