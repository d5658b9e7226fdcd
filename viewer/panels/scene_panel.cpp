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
std::string size_text(const Stage& stage) {
  std::size_t triangles = 0, splats = 0;
  for (const StageLayer& layer : stage.layers)
    (layer.soup() ? triangles : splats) += layer.primitive_count();
  if (splats == 0) return counted(triangles, "triangle");
  if (triangles == 0) return counted(splats, "splat");
  return counted(triangles, "triangle") + " and " + counted(splats, "splat");
}

/// Each once: "lattice texture, Gaussians (profile 3dgs)".
std::string appearances(const Stage& stage) {
  std::vector<std::string> names;
  for (const StageLayer& layer : stage.layers) {
    const auto* splats = std::get_if<Splats>(layer.primitives.get());
    const std::string name =
        splats ? fmt::format("{} (profile {}), harmonics of degree {}", kernel_name(splats->kernel),
                             profile_name(*splats), splats->color.degree)
               : appearance_name(layer.soup()->appearance);
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
  return all;
}

/// Powers of 1000, as on the page: "9.4 MB", "151 MB".
std::string megabytes(std::size_t bytes) {
  const double value = 1e-6 * double(bytes);
  return fmt::format("{:.{}f} MB", value, value < 9.95 ? 1 : 0);
}

}  // namespace

void scene_panel(State& state) {
  Stage& stage = *state.stage;
  const Scene& scene = *stage.scene;
  const char* label = "Name";
  for (const std::filesystem::path& path : stage.paths()) {
    fact(std::exchange(label, ""), short_name(path));
    tip(path.string());
  }
  if (!scene.info.source.empty()) fact("Source", scene.info.source);
  fact("Size", size_text(stage));
  fact("Appearance", appearances(stage));
  fact("GPU memory", megabytes(stage.renderer.device_bytes()));
  tip(fmt::format("read in {:.2f} s, prepared in {:.2f} s", stage.read_seconds,
                  stage.prepare_seconds));
  if (const auto notes = window_notes(scene.info); !notes.empty()) {
    heading("Notes");
    for (const std::string& note : notes) aside(note);
  }
  if (button("Open")) state.show_files = true;
  tip("O: replaces the scene; scenes that are dropped on the window become layers");
  ImGui::SameLine();
  recent_menu(state);
  ImGui::SameLine();
  if (button("Read again")) state.ask(ReloadScene{});
  tip("F5; a file that changes on disk is read again automatically");
}

}  // namespace tureen::viewer
