// The events that the interface receives in one frame.
#pragma once

#include <vector>

#include "viewer/input/event.hpp"

namespace tureen::viewer {

/// Takes the first events of `pending`, as many as Dear ImGui can tell apart: it reads the states
/// of keys, buttons and pointer once a frame. No button or key changes twice, the pointer stays
/// where a button was pressed or released, and keys and buttons change in different frames: a key
/// may open what is clicked, or be held for a drag; otherwise clicks would be lost when a frame
/// takes long. A screenshot ends a frame.
std::vector<Event> take_frame(std::vector<Event>& pending);

}  // namespace tureen::viewer
