// The list of keys.
#include <string>

#include "viewer/input/shortcuts.hpp"
#include "viewer/panels.hpp"
#include "viewer/panels/widgets.hpp"

namespace tureen::viewer {

namespace {

void row(const std::string& key, const std::string& what) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  text("{}", key);
  ImGui::TableNextColumn();
  text("{}", what);
}

void title(const char* name) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::TableNextColumn();
  ImGui::TextDisabled("%s", name);
}

}  // namespace

void keys_overlay(State& state) {
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0.5f * window.x, 0.5f * window.y}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::Begin("Keys", &state.show_keys,
               ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoMove);
  if (ImGui::BeginTable("keys", 2)) {
    title("Pointer");
    row("left drag", "turn the scene; in fly mode, the camera");
    row("right, middle, Shift+left", "move the scene");
    row("wheel", "distance; in fly mode, speed");
    row("double click", "centre a point");
    title("Flying");
    row("W A S D, Q E", "forward, left, back, right, down, up");
    row("with Shift, with Alt", "fast, slow");
    const char* group = "";
    for (const Shortcut& shortcut : shortcuts()) {
      if (std::string_view(group) != shortcut.group) title(group = shortcut.group);
      row((shortcut.control ? "Ctrl+" : "") + std::string(name_of(shortcut.key)), shortcut.text);
    }
    ImGui::EndTable();
  }
  ImGui::End();
}

}  // namespace tureen::viewer
