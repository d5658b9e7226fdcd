// The events that the interface receives in one frame.
#pragma once

#include <vector>

#include "viewer/input/event.hpp"

namespace tureen::viewer {

/// Takes the first events of `pending`, at most as many as Dear ImGui can tell apart: in each
/// frame, it sees only the last state of keys, buttons and pointer. No button or key changes twice;
/// the pointer stays where a button was pressed or released; keys and buttons change in different
/// frames, because a key may open what is clicked, or be held for a drag. A screenshot ends a
/// frame. All of one long frame at once would lose clicks.
std::vector<Event> take_frame(std::vector<Event>& pending);

}  // namespace tureen::viewer
