// A line at the lower left: the navigation mode, and the progress of jobs.
#include "viewer/panels.hpp"
#include "viewer/panels/widgets.hpp"

namespace tureen::viewer {

void status_overlay(const State& state) {
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({8, window.y - 8}, ImGuiCond_Always, {0, 1});
  ImGui::SetNextWindowBgAlpha(0.55f);
  ImGui::Begin("status", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs |
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings);
  if (state.writing) {
    text("{}", state.writing->what);
    ImGui::ProgressBar(float(state.writing->fraction), {16 * ImGui::GetFontSize(), 0});
  }
  if (state.busy) {
    text("{}", state.busy->what);
    ImGui::ProgressBar(float(state.busy->fraction), {16 * ImGui::GetFontSize(), 0});
  } else if (state.stage) {
    const bool flies = state.controls.mode() == NavigationMode::fly;
    text("{}   up {}   {} x {}   F1: keys", flies ? "fly" : "orbit", axis_name(state.controls.up()),
         state.pixels.x, state.pixels.y);
  } else {
    text("F1: keys");
  }
  ImGui::End();
}

}  // namespace tureen::viewer
