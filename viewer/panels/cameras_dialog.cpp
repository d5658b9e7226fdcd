// The dialog about photographs without cameras.
// clang-format off: the second header needs the first
#include <imgui/imgui.h>
#include <imgui/imgui_stdlib.h>
// clang-format on

#include "viewer/names.hpp"
#include "viewer/panels.hpp"
#include "viewer/panels/widgets.hpp"
#include "viewer/training_command.hpp"

namespace tureen::viewer {

void cameras_dialog(State& state) {
  auto& search = state.camera_search;
  const Dialog dialog("Photographs without cameras", search.has_value());
  if (!dialog.is_open()) return;
  paragraph(short_name(search->photographs) +
            " has no camera poses. COLMAP can estimate them in minutes; then a scene can be "
            "trained.");
  field("Dataset");
  if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
  const bool entered =
      ImGui::InputText("##dataset", &search->dataset, ImGuiInputTextFlags_EnterReturnsTrue);
  tip("Folder for the cameras and links to the photographs. An interrupted search in the same "
      "folder continues");
  const std::string defect = dataset_defect(search->dataset);
  if (!defect.empty()) aside(defect);
  const bool pressed = [&] {
    const Disabled disabled(search->dataset.empty() || !defect.empty());
    return strong_button("Find the cameras");
  }();
  ImGui::SameLine();
  const bool cancelled = button("Cancel") || escape_pressed();
  if ((pressed || entered) && !search->dataset.empty() && defect.empty()) {
    state.ask(FindCameras{search->photographs, search->dataset});
    search.reset();
  } else if (cancelled) {
    search.reset();
  }
}

}  // namespace tureen::viewer
