// The text in a window without a scene.
#include "viewer/panels.hpp"
#include "viewer/panels/widgets.hpp"

namespace tureen::viewer {

void welcome_overlay(State& state) {
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0.5f * window.x, 0.45f * window.y}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSize({32 * ImGui::GetFontSize(), 0});
  ImGui::Begin("welcome", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus);
  if (state.busy) {
    text("{} ..", state.busy->what);
    ImGui::ProgressBar(float(state.busy->fraction), {-1, 0});
  } else {
    paragraph("Drop a scene or a folder on the window.");
    aside(
        "Formats: .glb, .gltf, .off, .ply, .splat, .spz, .npz, .obj, .pt, DiffSoup exports, "
        "MobileNeRF scenes. Datasets of photographs: COLMAP, transforms.json.");
    ImGui::Spacing();
    if (ImGui::Button("Open ..")) state.show_files = true;
    if (!state.settings.recent.empty()) {
      ImGui::Spacing();
      aside("Recent scenes:");
      for (const std::string& path : state.settings.recent)
        if (ImGui::Selectable(path.c_str())) state.ask(OpenPath{path});
    }
  }
  ImGui::End();
}

}  // namespace tureen::viewer
