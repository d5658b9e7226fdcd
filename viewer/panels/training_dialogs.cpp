// The dialogs before a training starts, and before the window is closed during it.
// clang-format off: the second header needs the first
#include <imgui/imgui.h>
#include <imgui/imgui_stdlib.h>
// clang-format on

#include <algorithm>
#include <string>
#include <utility>

#include "base/decimal_text.hpp"
#include "viewer/names.hpp"
#include "viewer/panels.hpp"
#include "viewer/panels/widgets.hpp"
#include "viewer/training_command.hpp"

namespace tureen::viewer {

namespace {

/// A field for an option; empty: its default.
void option_field(const MethodOption& option, std::string& value) {
  if (option.type == MethodOption::Type::flag) {
    bool on = !value.empty();
    if (check(option.name, &on)) value = on ? "on" : "";
    tip(option.help);
    return;
  }
  field(option.name);
  const std::string id = std::string("##") + option.name;
  if (option.type != MethodOption::Type::word) {
    ImGui::InputTextWithHint(id.c_str(), "default", &value);
  } else if (ImGui::BeginCombo(id.c_str(), value.empty() ? "default" : value.c_str())) {
    if (list_item("default", value.empty())) value.clear();
    for (const std::string& word : option.words)
      if (list_item(word, word == value)) value = word;
    ImGui::EndCombo();
  }
  tip(option.help);
}

void size_field(TrainingChoice& choice) {
  static constexpr std::pair<const char*, const char*> scales[] = {
      {"", "automatic"}, {"1", "full"}, {"0.5", "1/2"}, {"0.25", "1/4"}, {"0.125", "1/8"}};
  const auto* const chosen = std::ranges::find(
      scales, choice.scale, [](const auto& each) { return std::string(each.first); });
  field("photographs");
  const std::string shown = chosen != std::end(scales) ? chosen->second : choice.scale;
  if (ImGui::BeginCombo("##scale", shown.c_str())) {
    if (chosen == std::end(scales)) list_item(shown, true);
    for (const auto& [scale, words] : scales)
      if (list_item(words, scale == choice.scale)) {
        choice.scale = scale;
        choice.scale_is_preset = false;
      }
    ImGui::EndCombo();
  }
  tip("Scale of the photographs. Smaller ones allow more steps in the same time.");
}

void method_fields(TrainingChoice& choice) {
  field("Method");
  if (ImGui::BeginCombo("##method", choice.method->name)) {
    for (const TrainingMethodInfo* method : training_methods())
      if (list_item(std::string(method->name) + ": " + method->summary, method == choice.method))
        choice.method = method;
    ImGui::EndCombo();
  }
  tip(choice.method->summary);
  const auto options = [&](bool common) {
    for (const MethodOption* option : choice.method->options)
      if (option->is_common == common) option_field(*option, choice.values[option->name]);
  };
  options(true);
  size_field(choice);
  if (!ImGui::TreeNode("Options")) return;
  field("steps");
  ImGui::InputTextWithHint("##steps", "default", &choice.steps);
  tip("number of steps, instead of minutes; by default that of the method");
  options(false);
  ImGui::TreePop();
}

/// The length and the size of the chosen training, by the speed of this computer.
void forecast_row(const State& state) {
  const FullPhotographs& full = state.photographs->full;
  if (full.cameras.empty() || !(state.training_seconds || state.measures_training)) return;
  fact("Forecast", state.training_seconds
                       ? forecast_text(state.training_choice, full, *state.training_seconds)
                       : "measuring this computer ..");
}

void start_dialog(State& state) {
  const Dialog dialog("Train a scene", state.scene_to_train.has_value());
  if (!dialog.is_open()) return;
  std::string& scene = *state.scene_to_train;
  const Photographs& photographs = *state.photographs;
  paragraph("Trains a scene from the " + counted(photographs.list.size(), "photograph") + " of " +
            short_name(photographs.path) + ". This takes minutes to hours.");
  field("Scene");
  if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
  const bool entered = ImGui::InputText("##scene", &scene, ImGuiInputTextFlags_EnterReturnsTrue);
  const TypedScene typed = check_typed_scene(scene);
  if (!typed.remark.empty()) aside(typed.remark);
  if (!typed.is_unfinished) {
    method_fields(state.training_choice);
    forecast_row(state);
  }
  aside("Another window shows the progress, and pauses or ends the training.");
  const bool pressed = [&] {
    const Disabled disabled(!typed.is_possible);
    return strong_button(typed.is_unfinished ? "Continue" : "Start");
  }();
  if ((pressed || entered) && typed.is_possible) {
    state.ask(StartTraining{
        scene, typed.is_unfinished ? TrainingStart::from_checkpoint : TrainingStart::new_run,
        state.training_choice});
    state.scene_to_train.reset();
    return;
  }
  ImGui::SameLine();
  if (button("Cancel") || escape_pressed()) state.scene_to_train.reset();
}

void quit_dialog(State& state) {
  const Dialog dialog("Quit", state.asks_before_quitting);
  if (!dialog.is_open()) return;
  paragraph("The training of " + short_name(state.started->scene) +
            " is in progress. After its first step, a stopped training can continue from its "
            "checkpoint.");
  if (button("Stop the training")) state.ask(Quit{Quit::Training::stop, true});
  ImGui::SameLine();
  if (button("Let it continue")) state.ask(Quit{Quit::Training::let_continue, true});
  ImGui::SameLine();
  if (button("Cancel") || escape_pressed()) state.asks_before_quitting = false;
}

}  // namespace

void training_dialogs(State& state) {
  if (!state.photographs) state.scene_to_train.reset();
  start_dialog(state);
  quit_dialog(state);
}

}  // namespace tureen::viewer
