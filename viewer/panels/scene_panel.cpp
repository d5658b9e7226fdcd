// The scene: path, contents, memory and notes; buttons to open others.
#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "base/decimal_text.hpp"
#include "viewer/names.hpp"
#include "viewer/panels.hpp"
#include "viewer/panels/widgets.hpp"
#include "viewer/shortcuts.hpp"

namespace tureen::viewer {

namespace {

void recent_menu(State& state) {
  if (button("Recent")) ImGui::OpenPopup("recent");
  if (!ImGui::BeginPopup("recent")) return;
  if (state.settings.recent.empty()) aside("none");
  for (const std::string& path : state.settings.recent)
    if (ImGui::MenuItem(path.c_str())) state.ask(OpenPath{path});
  ImGui::EndPopup();
}

/// As on the page: "7,000 triangles and 90,854 splats".
std::string size_text(const Document& document) {
  std::size_t triangles = 0, splats = 0;
  for (const DocumentLayer& layer : document.layers)
    (soup_of(layer) ? triangles : splats) += primitive_count(layer);
  if (splats == 0) return counted(triangles, "triangle");
  if (triangles == 0) return counted(splats, "splat");
  return counted(triangles, "triangle") + " and " + counted(splats, "splat");
}

/// Each once: "lattice texture, Gaussians (profile 3dgs)".
std::string appearances(const Document& document) {
  std::vector<std::string> names;
  for (const DocumentLayer& layer : document.layers) {
    const Splats* const splats = splats_of(layer);
    const std::string name =
        splats ? fmt::format("{} (profile {}), harmonics of degree {}", kernel_name(splats->kernel),
                             profile_name(*splats), splats->color.degree)
               : appearance_name(soup_of(layer)->appearance);
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
  return all;
}

/// The box around all layers, and its extent.
void box_facts(const Document& document) {
  const Subject box =
      subject_of(std::vector<LayerPlace>(document.layers.begin(), document.layers.end()), {});
  const glm::dvec3 extent = box.high - box.low;
  const auto list = [](const glm::dvec3& v) {
    return fmt::format("{:.4g}, {:.4g}, {:.4g}", v.x, v.y, v.z);
  };
  fact("Extent", fmt::format("{:.4g} \u00d7 {:.4g} \u00d7 {:.4g}", extent.x, extent.y, extent.z));
  tip("Size of the box around all layers along x, y and z, in world units. Splats count with their "
      "faint edges, but not if they are far from all others");
  fact("Box", fmt::format("{}\nto {}", list(box.low), list(box.high)));
  tip("Lowest and highest corner: x, y, z");
}

/// Fewer would be rounded to 0.0 MB.
constexpr std::size_t shown_bytes = 50'000;

/// Powers of 1000, as on the page: "9.4 MB", "151 MB".
std::string megabytes(std::size_t bytes) {
  const double value = 1e-6 * double(bytes);
  if (bytes < shown_bytes) return "less than 0.1 MB";
  return fmt::format("{:.{}f} MB", value, value < 9.95 ? 1 : 0);
}

/// The steps of the history: a click undoes or redoes up to there.
void steps_menu(State& state) {
  const History& history = state.history;
  {
    const Disabled disabled(history.steps().empty());
    if (button("Steps")) ImGui::OpenPopup("steps");
  }
  tip("List of changes; click one to return to it");
  if (!ImGui::BeginPopup("steps")) return;
  if (escape_pressed()) ImGui::CloseCurrentPopup();
  const std::size_t position = history.position();
  if (ImGui::Selectable("Before the first step", position == 0)) state.ask(GoToStep{0});
  for (std::size_t i = 0; i < history.steps().size(); ++i) {
    ImGui::PushID(int(i));
    // Not the label of the selectable: names come from files, and "##" has a meaning for Dear
    // ImGui.
    const float left = ImGui::GetCursorPosX();
    if (ImGui::Selectable("##step", position == i + 1)) state.ask(GoToStep{i + 1});
    ImGui::SameLine(left);
    const Disabled disabled(i >= position);  // undone steps are dimmed
    text("{}", history.steps()[i].name);
    ImGui::PopID();
  }
  ImGui::EndPopup();
}

void step_button(State& state, const char* label, Key key, bool possible) {
  const Disabled disabled(!possible);
  if (button(label)) run_shortcut(key, With::control, state);
}

void history_buttons(State& state) {
  const History& history = state.history;
  step_button(state, "Undo", Key::z, history.position() > 0);
  tip("Ctrl+Z");
  ImGui::SameLine();
  step_button(state, "Redo", Key::y, history.position() < history.steps().size());
  tip("Ctrl+Y, Ctrl+Shift+Z");
  ImGui::SameLine();
  steps_menu(state);
}

/// Closed at first: a message has shown them when the scene was opened.
void notes_rows(const SceneInfo& info) {
  const std::vector<std::string> notes = window_notes(info);
  if (notes.empty() || !ImGui::TreeNode("notes", "Notes (%zu)", notes.size())) return;
  for (const std::string& note : notes) aside(note);
  ImGui::TreePop();
}

void fact_rows(const State& state) {
  const SceneSource& source = state.source;
  const Document& document = source.document;
  const SceneInfo& info = source.scene->info;
  const char* label = "Name";
  for (const std::filesystem::path& path : source.paths()) {
    const bool changed = *label != '\0' && !state.history.is_saved();
    fact(std::exchange(label, ""), short_name(path) + (changed ? " *" : ""));
    tip(path.string() + (changed ? ", with unsaved changes" : ""));
  }
  if (!info.source.empty()) fact("Source", info.source);
  fact("Size", size_text(document));
  box_facts(document);
  fact("Appearance", appearances(document));
  const Renderer& renderer = state.stage->renderer;
  fact("GPU memory", renderer.plan().splats_in_tiles && renderer.device_bytes() < shown_bytes
                         ? "none: the processor draws the splats"
                         : megabytes(renderer.device_bytes()));
  tip(fmt::format("read in {:.2f} s, prepared in {:.2f} s", source.read_seconds,
                  state.stage->prepare_seconds));
}

/// The levels of detail of streamed scenes.
void level_rows(State& state) {
  const std::vector<SceneFile>& files = state.source.files;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const std::optional<DetailLevels> levels = levels_of(files[i]);
    if (!levels || levels->count < 2 || !has_layers(state.source, i)) continue;
    const auto name = [&](std::size_t level) {
      return std::to_string(level) + (level == 0                   ? " (finest)"
                                      : level + 1 == levels->count ? " (coarsest)"
                                                                   : "");
    };
    ImGui::PushID(int(i));
    field("Level");
    if (ImGui::BeginCombo("##level", name(levels->level).c_str())) {
      for (std::size_t level = 0; level < levels->count; ++level)
        if (list_item(name(level), level == levels->level) && level != levels->level)
          state.ask(ChooseLevel{i, level});
      ImGui::EndCombo();
    }
    tip("Level of detail of " + short_name(files[i].path));
    ImGui::PopID();
  }
}

}  // namespace

void scene_panel(State& state) {
  // Many short rows: closer than those of fields.
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing,
                      ImVec2(ImGui::GetStyle().ItemSpacing.x, 0.2f * ImGui::GetFontSize()));
  fact_rows(state);
  ImGui::PopStyleVar();
  level_rows(state);
  notes_rows(state.source.scene->info);
  if (button("Open")) state.show_files = true;
  tip("O: replaces the scene, or adds layers to it");
  ImGui::SameLine();
  recent_menu(state);
  ImGui::SameLine();
  if (button("Save")) state.ask(SaveScene{});
  tip("Ctrl+S: saves the scene to its file");
  ImGui::SameLine();
  if (button("Save as")) state.ask(SaveSceneAs{});
  history_buttons(state);
  ImGui::SameLine();
  if (button("Read again")) state.ask(ReloadScene{});
  tip("F5; a file that changes on disk is read again automatically");
}

}  // namespace tureen::viewer
