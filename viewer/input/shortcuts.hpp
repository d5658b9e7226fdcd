// The keys, in one table: what each does, and how the list of keys calls it.
#pragma once

#include <span>

#include "viewer/input/event.hpp"
#include "viewer/state.hpp"

namespace tureen::viewer {

struct Shortcut {
  Key key;
  bool control;       // with Ctrl
  const char* group;  // of the list of keys
  const char* text;
  void (*run)(State& state);
};

std::span<const Shortcut> shortcuts();

/// Runs what the key means; whether it means anything.
bool run_shortcut(Key key, bool control, State& state);

}  // namespace tureen::viewer
