// The list of keys.
#include <algorithm>
#include <string>
#include <string_view>

#include "viewer/panels.hpp"
#include "viewer/panels/widgets.hpp"
#include "viewer/shortcuts.hpp"

namespace tureen::viewer {

namespace {

/// Width of a key's name, in font heights.
constexpr float key_width = 9.5f;

void row(const std::string& key, const std::string& what) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  text("{}", key);
  ImGui::TableNextColumn();
  aside(what);
}

/// A heading and the rows that `rows` adds, in a table of this width.
template <class Rows>
void group(const char* name, float width, Rows rows) {
  heading(name);
  if (!ImGui::BeginTable(name, 2, ImGuiTableFlags_None, {width, 0})) return;
  ImGui::TableSetupColumn("key", ImGuiTableColumnFlags_WidthFixed,
                          key_width * ImGui::GetFontSize());
  ImGui::TableSetupColumn("meaning", ImGuiTableColumnFlags_WidthStretch);
  rows();
  ImGui::EndTable();
}

void keys_of(std::string_view name) {
  for (const Shortcut& shortcut : shortcuts())
    if (shortcut.text && shortcut.group == name)
      row((shortcut.with == With::control ? "Ctrl+" : "") + std::string(name_of(shortcut.key)),
          shortcut.text);
}

}  // namespace

void keys_overlay(State& state) {
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  const float em = ImGui::GetFontSize();
  ImGui::SetNextWindowPos({0.5f * window.x, 0.5f * window.y}, ImGuiCond_Always, {0.5f, 0.5f});
  const float width = std::min(50 * em, window.x - em);
  ImGui::SetNextWindowSizeConstraints({width, 0}, {width, window.y - em});
  // Dear ImGui measures the list too high before it wraps texts, and would keep a scroll bar.
  const bool fits = window.x > 51 * em && window.y > 40 * em;
  ImGui::Begin("Keys and gestures", &state.show_keys,
               (fits ? ImGuiWindowFlags_NoScrollbar : ImGuiWindowFlags_None) |
                   ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoMove | ImGuiWindowFlags_AlwaysAutoResize);
  const float half = share_of_row(2);
  ImGui::BeginGroup();
  group("Pointer", half, [] {
    row("Drag", "turn the scene; when flying, turn the camera");
    row("Right drag, Shift drag", "move the scene");
    row("Wheel", "zoom; when flying, change the speed");
    row("Double click", "centre a point");
  });
  group("Moving", half, [] {
    row("W A S D, Q E", "fly; Shift: fast, Alt: slow");
    row("Arrows", "turn; with Shift, move");
    row("+ \u2212", "zoom in, zoom out");
    row("1 to 9", "front, back, sides, top, bottom, corners");
    keys_of("Moving");
  });
  group("Camera path", half, [] { keys_of("Camera path"); });
  ImGui::EndGroup();
  ImGui::SameLine();
  ImGui::BeginGroup();
  group("Keys", half, [] { keys_of("Keys"); });
  group("Window", half, [] { keys_of("Window"); });
  ImGui::EndGroup();
  ImGui::End();
}

}  // namespace tureen::viewer
