// The card of a window without a scene: opens files, the example and recent scenes.
#include <algorithm>
#include <filesystem>
#include <optional>

#include "base/decimal_text.hpp"
#include "base/platform/program_folder.hpp"
#include "formats/scene_file.hpp"
#include "viewer/names.hpp"
#include "viewer/panels.hpp"
#include "viewer/panels/widgets.hpp"

namespace tureen::viewer {

namespace {

namespace fs = std::filesystem;

/// The example scene that comes with the program; nullopt if it is not near the program.
std::optional<fs::path> find_example() {
  const std::optional<fs::path> folder = program_folder();
  if (!folder) return std::nullopt;
  std::error_code ignored;
  // Beside bin/ in builds, beside the program in a portable folder.
  for (const fs::path& file :
       {folder->parent_path() / "share/tureen/example.glb", *folder / "examples/soup.glb"})
    if (fs::is_regular_file(file, ignored)) return file;
  return std::nullopt;
}

void recent_rows(State& state) {
  if (state.settings.recent.empty()) return;
  ImGui::Spacing();
  heading("Recent scenes");
  for (const std::string& path : state.settings.recent)
    if (ImGui::Selectable(path.c_str())) state.ask(OpenPath{path});
}

/// Photographs without a scene: what can be done with them.
void dataset_rows(State& state) {
  const Photographs& photographs = *state.photographs;
  {
    const Title title;
    text("{}", short_name(photographs.path));
  }
  paragraph(counted(photographs.list.size(), "photograph") +
            " and no scene. Train a scene from them, or open one to compare it with them.");
  dataset_buttons(state);
  ImGui::Spacing();
}

/// ".glb, .gltf, .off, folders (DiffSoup export, SOG)".
std::string read_formats() {
  std::string files, folders;
  for (const FormatInfo& format : known_formats()) {
    if (!format.can_read) continue;
    for (const std::string& extension : format.read_extensions) files += extension + ", ";
    if (format.is_folder) folders += (folders.empty() ? "" : ", ") + format.name;
  }
  return files + "folders (" + folders + ")";
}

}  // namespace

void welcome_overlay(State& state) {
  if (state.busy) return;  // the progress is shown instead
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  const float em = ImGui::GetFontSize();
  ImGui::SetNextWindowPos({0.5f * window.x, 0.45f * window.y}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSize({std::min(36 * em, window.x - 2 * em), 0});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(1.8f * em, 1.5f * em));
  ImGui::Begin("welcome", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus);
  ImGui::PopStyleVar();
  started_training_rows(state);
  if (state.photographs) dataset_rows(state);
  {
    const Title title;
    text("Open a scene");
  }
  aside(
      "Choose a file or a folder, or drop one on this window. Files that you drop on a scene "
      "become layers.");
  ImGui::Spacing();
  if (strong_button("Choose a file or a folder")) state.show_files = true;
  tip("O");
  static const std::optional<fs::path> example = find_example();  // asked in every frame
  if (example) {
    ImGui::SameLine();
    if (button("Open the example")) state.ask(OpenPath{*example});
  }
  recent_rows(state);
  ImGui::Spacing();
  heading("Supported formats");
  aside("Scenes: " + read_formats() +
        ". Photographs: with cameras of COLMAP, Bundler or transforms.json; a folder or a video "
        "without.");
  ImGui::End();
}

}  // namespace tureen::viewer
