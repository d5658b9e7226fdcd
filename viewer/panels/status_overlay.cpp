// A line at the lower left of the image: navigation, size, and where the help is.
#include "viewer/panels.hpp"
#include "viewer/panels/widgets.hpp"

namespace tureen::viewer {

void status_overlay(const State& state) {
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  const float em = ImGui::GetFontSize();
  ImGui::SetNextWindowPos({0.6f * em, window.y - 0.6f * em}, ImGuiCond_Always, {0, 1});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0.6f * em, 0.25f * em));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1, 1));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0f);
  ImGui::SetNextWindowBgAlpha(0.88f);
  ImGui::Begin("status", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs |
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings);
  ImGui::PopStyleVar(3);
  if (state.stage) {
    const bool flies = state.controls.mode() == NavigationMode::fly;
    text("{} \u00b7 up {} \u00b7 {} \u00d7 {} \u00b7 F1: help{}", flies ? "Fly" : "Orbit",
         axis_name(state.controls.up()), state.pixels.x, state.pixels.y,
         tracing_text(state.traced));
  } else {
    text("F1: help");
  }
  ImGui::End();
}

}  // namespace tureen::viewer
