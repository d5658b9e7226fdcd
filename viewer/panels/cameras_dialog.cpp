// The dialog about photographs without cameras.
// clang-format off: the second header needs the first
#include <imgui/imgui.h>
#include <imgui/imgui_stdlib.h>
// clang-format on

#include "viewer/names.hpp"
#include "viewer/panels.hpp"
#include "viewer/panels/widgets.hpp"

namespace tureen::viewer {

void cameras_dialog(State& state) {
  auto& search = state.camera_search;
  const Dialog dialog("Photographs without cameras", search.has_value());
  if (!dialog.is_open()) return;
  paragraph("It is not known where the photographs of " + short_name(search->photographs) +
            " were taken. COLMAP finds their cameras in minutes; then a scene can be trained from "
            "them.");
  field("Dataset");
  if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
  const bool entered =
      ImGui::InputText("##dataset", &search->dataset, ImGuiInputTextFlags_EnterReturnsTrue);
  tip("The folder for the cameras, and for links to the photographs. An interrupted search of the "
      "same folder continues");
  const bool pressed = strong_button("Find the cameras");
  ImGui::SameLine();
  const bool cancelled = button("Cancel") || escape_pressed();
  if ((pressed || entered) && !search->dataset.empty()) {
    state.ask(FindCameras{search->photographs, search->dataset});
    search.reset();
  } else if (cancelled) {
    search.reset();
  }
}

}  // namespace tureen::viewer
