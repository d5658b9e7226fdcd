// Where the controls of the interface are, by name, so that a session can click them wherever the
// panel has them (viewer/files/session.hpp).
#pragma once

#include <glm/vec2.hpp>
#include <optional>
#include <string>

namespace tureen::viewer {

/// Notes the last control of Dear ImGui under a name, unless it is scrolled out of sight. Of equal
/// names, the last one counts: dialogs come last.
void note_item(const std::string& name);
/// Notes the field that follows at the cursor.
void note_field(const std::string& name);
/// Notes a place on the image, in points.
void note_place(const std::string& name, const glm::dvec2& place);

/// Ends a frame of notes.
void end_item_notes();
/// A point inside the control that the last frame showed under this name, in points.
std::optional<glm::dvec2> item_place(const std::string& name);

}  // namespace tureen::viewer
