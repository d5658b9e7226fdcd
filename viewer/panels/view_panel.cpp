// The camera's position and navigation.
#include <algorithm>

#include "viewer/axes.hpp"
#include "viewer/input/shortcuts.hpp"
#include "viewer/panels.hpp"
#include "viewer/panels/widgets.hpp"

namespace tureen::viewer {

namespace {

void mode_buttons(CameraControls& controls) {
  int mode = static_cast<int>(controls.mode());
  ImGui::RadioButton("orbit", &mode, static_cast<int>(NavigationMode::orbit));
  tip("A drag turns the scene, the wheel changes the distance. Tab changes the mode");
  ImGui::SameLine();
  ImGui::RadioButton("fly", &mode, static_cast<int>(NavigationMode::fly));
  tip("A drag turns the camera, W A S D Q E fly, the wheel sets the speed. Tab changes the mode");
  controls.set_mode(static_cast<NavigationMode>(mode));
  ImGui::SameLine();
  aside(fmt::format("{:.3g} units a second", controls.speed()));
}

void up_menu(State& state) {
  CameraControls& controls = state.controls;
  ImGui::SetNextItemWidth(6 * ImGui::GetFontSize());
  if (ImGui::BeginCombo("up", axis_name(controls.up()).c_str())) {
    for (const glm::dvec3& axis : up_axes)
      if (ImGui::Selectable(axis_name(axis).c_str(), is_axis(controls.up(), axis)))
        controls.set_up(axis);
    ImGui::EndCombo();
  }
  tip(describe(state.stage->up) + ". U changes it");
}

void view_menu(CameraControls& controls) {
  ImGui::SetNextItemWidth(10 * ImGui::GetFontSize());
  if (!ImGui::BeginCombo("##views", "view from ..")) return;
  for (const NamedView view : named_views)
    if (ImGui::Selectable(name_of(view))) {
      controls.set_mode(NavigationMode::orbit);
      controls.look_from(view);
    }
  ImGui::EndCombo();
}

void recorded_slider(State& state) {
  const auto cameras = state.recorded_cameras();
  if (cameras.empty()) return;
  int index = std::min(state.recorded, int(cameras.size()) - 1);
  // The slider needs a printf format, but names come from files, so "%" is escaped.
  std::string name = index < 0 ? "none" : fmt::format("{}: ", index);
  if (index >= 0)
    for (const char letter : cameras[std::size_t(index)]->name)
      name += letter == '%' ? std::string("%%") : std::string(1, letter);
  ImGui::SetNextItemWidth(12 * ImGui::GetFontSize());
  if (ImGui::SliderInt("recorded", &index, 0, int(cameras.size()) - 1, name.c_str(),
                       ImGuiSliderFlags_AlwaysClamp))
    state.ask(ShowRecorded{index});
  tip("The cameras of the dataset, or of the scene. [ and ] select them");
}

}  // namespace

void view_panel(State& state) {
  CameraControls& controls = state.controls;
  mode_buttons(controls);
  view_menu(controls);
  ImGui::SameLine();
  up_menu(state);
  if (ImGui::Button("Frame")) run_shortcut(Key::f, false, state);
  tip("F: show the whole scene");
  ImGui::SameLine();
  if (ImGui::Button("Reset")) run_shortcut(Key::r, false, state);
  tip("R: the first view");
  ImGui::SameLine();
  auto fov = static_cast<float>(controls.fov() * degrees_per_radian);
  ImGui::SetNextItemWidth(7 * ImGui::GetFontSize());
  if (ImGui::SliderFloat("angle", &fov, 5, 120, "%.1f deg", ImGuiSliderFlags_AlwaysClamp))
    controls.set_fov(fov / degrees_per_radian);
  recorded_slider(state);
  const glm::dvec3 eye = controls.eye();
  aside(fmt::format("eye {:.7g}, {:.7g}, {:.7g}", eye.x, eye.y, eye.z));
  ImGui::Checkbox("smooth motion", &state.settings.smooth_motion);
}

}  // namespace tureen::viewer
