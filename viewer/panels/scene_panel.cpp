// The scene: path, contents, memory and notes; buttons to open others.
#include <filesystem>

#include "viewer/panels.hpp"
#include "viewer/panels/widgets.hpp"

namespace tureen::viewer {

namespace {

void recent_menu(State& state) {
  if (ImGui::Button("Recent")) ImGui::OpenPopup("recent");
  if (!ImGui::BeginPopup("recent")) return;
  if (state.settings.recent.empty()) aside("none");
  for (const std::string& path : state.settings.recent)
    if (ImGui::MenuItem(path.c_str())) state.ask(OpenPath{path});
  ImGui::EndPopup();
}

}  // namespace

void scene_panel(State& state) {
  Stage& stage = *state.stage;
  const Scene& scene = *stage.scene;
  for (const std::filesystem::path& path : stage.paths()) paragraph(path.string());
  if (stage.layers.size() == 1) {
    const StageLayer& layer = stage.layers.front();
    paragraph(layer.soup() ? fmt::format("{} triangles, {}", layer.primitive_count(),
                                         appearance_name(layer.soup()->appearance))
                           : describe(std::get<Splats>(*layer.primitives)));
  } else {
    std::size_t triangles = 0, splats = 0;
    for (const StageLayer& layer : stage.layers)
      (layer.soup() ? triangles : splats) += layer.primitive_count();
    if (splats == 0)
      text("{} triangles in {} layers", triangles, stage.layers.size());
    else
      paragraph(fmt::format("{} triangles and {} splats in {} layers", triangles, splats,
                            stage.layers.size()));
  }
  text("{:.1f} MiB on the device", double(stage.renderer.device_bytes()) / (1 << 20));
  tip(fmt::format("read in {:.2f} s, prepared in {:.2f} s", stage.read_seconds,
                  stage.prepare_seconds));
  if (!scene.info.source.empty()) aside("from " + scene.info.source);
  for (const std::string& note : all_notes(scene.info)) aside(note);
  if (ImGui::Button("Open")) state.show_files = true;
  tip("Ctrl+O replaces the scene; scenes that are dropped on the window are added");
  ImGui::SameLine();
  recent_menu(state);
  ImGui::SameLine();
  if (ImGui::Button("Read again")) state.ask(ReloadScene{});
  tip("F5; a file that changes on disk is read again automatically");
}

}  // namespace tureen::viewer
