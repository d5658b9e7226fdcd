// A window to select a file or a folder, or to type a path.
// clang-format off: the second header needs the first
#include <imgui/imgui.h>
#include <imgui/imgui_stdlib.h>
// clang-format on

#include <algorithm>
#include <filesystem>

#include "formats/dataset/dataset.hpp"
#include "formats/scene_file.hpp"
#include "viewer/panels.hpp"
#include "viewer/panels/widgets.hpp"

namespace tureen::viewer {

namespace {

namespace fs = std::filesystem;

void open(State& state, const fs::path& path) {
  if (state.adds_files)
    state.ask(AddPaths{{path}});
  else
    state.ask(OpenPath{path});
  state.show_files = false;
}

/// The folder of the scene, otherwise the working folder.
fs::path first_folder(const State& state) {
  std::error_code ignored;
  return state.stage ? fs::absolute(state.source.path(), ignored).parent_path()
                     : fs::current_path(ignored);
}

/// Returns the selected folder, empty if none.
fs::path folder_buttons(State& state) {
  fs::path next;
  if (button("Up")) next = state.files.folder.parent_path();
  ImGui::SameLine();
  if (button("Choose this folder")) open(state, state.files.folder);
  tip("A dataset, photographs, a DiffSoup export, a MobileNeRF model");
  if (state.stage) {
    ImGui::SameLine();
    check_beside_field("Add to the scene", &state.adds_files);
    tip("Adds scenes as layers, as if they were dropped on the window");
  }
  return next;
}

/// Returns the selected folder, empty if none.
fs::path entries(State& state) {
  fs::path next;
  const FileList& files = state.files;
  const float rows_below = files.typed_trouble.empty() ? 2 : 4;
  ImGui::BeginChild("list", {0, -rows_below * ImGui::GetFrameHeightWithSpacing()}, true);
  if (!files.trouble.empty()) aside(files.trouble);
  if (files.has_photographs)
    aside("This folder has photographs: \"Choose this folder\" opens them.");
  else if (files.entries.empty() && files.trouble.empty())
    aside("This folder has no scenes, datasets or folders.");
  for (const FileEntry& entry : files.entries) {
    const std::string name = entry.path.filename().string() + (entry.is_folder ? "/" : "");
    if (!ImGui::Selectable(name.c_str())) continue;
    if (entry.is_folder)
      next = entry.path;
    else
      open(state, entry.path);
  }
  if (files.cut) aside("The list is incomplete: type the path.");
  ImGui::EndChild();
  return next;
}

/// Opens the typed path, except a folder that is no scene and no dataset, and has no photographs:
/// then returns it.
fs::path open_typed(State& state) {
  fs::path path = typed_path(state.files);
  std::error_code ignored;
  if (!fs::exists(path, ignored)) {
    state.files.typed_trouble = "There is no file or folder " + path.string() + ".";
    return {};
  }
  if (fs::is_directory(path, ignored) && !is_dataset(path) && !is_scene(path) &&
      !list_files(path).has_photographs)
    return path;
  open(state, path);
  return {};
}

/// Returns the selected folder, empty if none.
fs::path path_field(State& state) {
  FileList& files = state.files;
  if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
  ImGui::SetNextItemWidth(-5 * ImGui::GetFontSize());
  const bool entered = ImGui::InputTextWithHint("##path", "or type a path", &files.typed,
                                                ImGuiInputTextFlags_EnterReturnsTrue);
  if (ImGui::IsItemEdited()) files.typed_trouble.clear();
  fs::path next;
  if (entered && !files.typed.empty()) {
    next = open_typed(state);
    if (!files.typed_trouble.empty()) ImGui::SetKeyboardFocusHere(-1);  // Enter ends the editing
  }
  ImGui::SameLine();
  if (button("Open") && !files.typed.empty()) next = open_typed(state);
  if (!files.typed_trouble.empty()) paragraph(files.typed_trouble);
  return next;
}

}  // namespace

void files_overlay(State& state) {
  if (state.files.folder.empty()) state.files = list_files(first_folder(state));
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0.5f * window.x, 0.5f * window.y}, ImGuiCond_Appearing, {0.5f, 0.5f});
  ImGui::SetNextWindowSize({std::min(36 * ImGui::GetFontSize(), window.x),
                            std::min(28 * ImGui::GetFontSize(), window.y)},
                           ImGuiCond_Appearing);
  ImGui::Begin("Open a scene", &state.show_files,
               ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings);
  paragraph(state.files.folder.string());
  const fs::path next[] = {folder_buttons(state), entries(state), path_field(state)};
  ImGui::End();
  for (const fs::path& folder : next)
    if (!folder.empty()) state.files = list_files(folder);
  // Outside of the field, Escape is a shortcut.
  if (escape_pressed() && ImGui::GetIO().WantTextInput && !state.has_dialog())
    state.show_files = false;
  if (!state.show_files) {
    state.files = {};
    state.adds_files = false;
  }
}

}  // namespace tureen::viewer
