// The dialogs before a training starts, and before the window is closed during it.
// clang-format off: the second header needs the first
#include <imgui/imgui.h>
#include <imgui/imgui_stdlib.h>
// clang-format on

#include <filesystem>

#include "base/decimal_text.hpp"
#include "viewer/names.hpp"
#include "viewer/panels.hpp"
#include "viewer/panels/widgets.hpp"

namespace tureen::viewer {

namespace {

namespace fs = std::filesystem;

void start_dialog(State& state) {
  std::string& scene = *state.scene_to_train;
  const Photographs& photographs = *state.photographs;
  const Dialog dialog("Train a scene");
  paragraph("Trains a scene from the " + counted(photographs.list.size(), "photograph") + " of " +
            short_name(photographs.path) + ". This takes minutes to hours.");
  field("Scene");
  if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
  const bool entered = ImGui::InputText("##scene", &scene, ImGuiInputTextFlags_EnterReturnsTrue);
  std::error_code ignored;
  if (fs::exists(scene, ignored)) aside("This file exists. The training replaces it.");
  aside("Another window shows the progress, and pauses or ends the training.");
  if ((strong_button("Start") || entered) && !scene.empty()) {
    state.ask(StartTraining{scene});
    state.scene_to_train.reset();
    return;
  }
  ImGui::SameLine();
  if (button("Cancel") || escape_pressed()) state.scene_to_train.reset();
}

void quit_dialog(State& state) {
  const Dialog dialog("Quit");
  paragraph("The training of " + short_name(state.started->scene) +
            " is in progress. After its first step, a stopped training can continue from its "
            "checkpoint.");
  if (button("Stop the training")) state.ask(Quit{Quit::Training::stop});
  ImGui::SameLine();
  if (button("Let it continue")) state.ask(Quit{Quit::Training::let_continue});
  ImGui::SameLine();
  if (button("Cancel") || escape_pressed()) state.asks_before_quitting = false;
}

}  // namespace

void training_dialogs(State& state) {
  if (!state.photographs) state.scene_to_train.reset();
  if (state.scene_to_train) start_dialog(state);
  if (state.asks_before_quitting) quit_dialog(state);
}

}  // namespace tureen::viewer
