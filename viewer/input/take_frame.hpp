// The events that the interface receives in one frame.
#pragma once

#include <vector>

#include "viewer/input/event.hpp"

namespace tureen::viewer {

/// Takes the first events of `pending`, as many as Dear ImGui can tell apart: it reads the states
/// of keys, buttons and pointer once a frame. No button or key changes twice, the pointer stays
/// where a button was pressed or released, and a button changes after the frame of a key, which may
/// open what it clicks; otherwise clicks would be lost when a frame takes long. A screenshot ends a
/// frame.
std::vector<Event> take_frame(std::vector<Event>& pending);

}  // namespace tureen::viewer
