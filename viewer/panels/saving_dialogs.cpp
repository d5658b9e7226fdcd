// The dialogs about saving: the name of the file, the losses of its format, and the question before
// unsaved changes are lost.
// clang-format off: the second header needs the first
#include <imgui/imgui.h>
#include <imgui/imgui_stdlib.h>
// clang-format on

#include <filesystem>
#include <system_error>
#include <utility>

#include "viewer/names.hpp"
#include "viewer/panels.hpp"
#include "viewer/panels/widgets.hpp"
#include "viewer/scene/saving.hpp"

namespace tureen::viewer {

namespace {

namespace fs = std::filesystem;

void name_dialog(State& state) {
  auto& name = state.saving.name;
  const Dialog dialog("Save the scene as", name.has_value());
  if (!dialog.is_open()) return;
  const fs::path file = name->folder / name->typed;
  paragraph("In the folder " + file.parent_path().string());
  field("File");
  if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
  const bool entered =
      ImGui::InputText("##file", &name->typed,
                       ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
  const std::string defect = name_defect(state.source, file);
  std::error_code unknown;
  const bool exists = fs::exists(file, unknown);
  aside(!defect.empty() ? defect
        : exists        ? "This file exists. It will be replaced."
                        : written_extensions(state.source));
  const bool pressed = [&] {
    const Disabled disabled(!defect.empty());
    return strong_button(exists ? "Replace" : "Save");
  }();
  ImGui::SameLine();
  const bool cancelled = button("Cancel") || escape_pressed();
  if ((pressed || entered) && defect.empty()) {
    state.ask(SaveScene{.file = file, .then = name->then});
    name.reset();
  } else if (cancelled) {
    name.reset();
  }
}

void losses_dialog(State& state) {
  auto& losses = state.saving.losses;
  const Dialog dialog("The format loses a part of the scene", losses.has_value());
  if (!dialog.is_open()) return;
  paragraph("Lost in " + short_name(losses->request.file) + ":");
  for (const std::string& each : losses->lost) aside(each);
  const bool saves = strong_button("Save anyway") || enter_pressed();
  ImGui::SameLine();
  const bool renames = button("Another name");
  ImGui::SameLine();
  const bool cancelled = button("Cancel") || escape_pressed();
  if (saves) {
    SaveScene request = losses->request;
    request.accepts_losses = true;
    state.ask(request);
  } else if (renames) {
    state.ask(SaveSceneAs{});
  }
  if (saves || renames || cancelled) losses.reset();
}

void leaving_dialog(State& state) {
  auto& leaving = state.saving.leaving;
  const Dialog dialog("Unsaved changes", leaving.has_value());
  if (!dialog.is_open()) return;
  paragraph("The changes of " + short_names(state.source.paths()) + " are not saved.");
  const bool saves = strong_button("Save") || enter_pressed();
  ImGui::SameLine();
  const bool discards = button("Discard");
  ImGui::SameLine();
  const bool cancelled = button("Cancel") || escape_pressed();
  if (saves) {
    state.ask(SaveScene{.then = leaving});
  } else if (discards && leaving->opens.empty()) {
    state.ask(Quit{.discards = true});
  } else if (discards) {
    state.ask(OpenPath{leaving->opens, true});
  }
  if (saves || discards || cancelled) leaving.reset();
}

}  // namespace

void saving_dialogs(State& state) {
  name_dialog(state);
  losses_dialog(state);
  leaving_dialog(state);
}

}  // namespace tureen::viewer
