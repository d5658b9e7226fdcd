// The camera's position and navigation.
#include <algorithm>
#include <iterator>

#include "viewer/axes.hpp"
#include "viewer/panels.hpp"
#include "viewer/panels/widgets.hpp"
#include "viewer/shortcuts.hpp"

namespace tureen::viewer {

namespace {

void mode_buttons(CameraControls& controls) {
  static constexpr const char* modes[] = {"Orbit", "Fly"};
  int mode = static_cast<int>(controls.mode());
  if (segments("mode", modes, mode)) controls.set_mode(static_cast<NavigationMode>(mode));
  tip("Orbit: a drag turns the scene, the wheel changes the distance. Fly: a drag turns the "
      "camera, W A S D Q E fly, the wheel changes the speed. M switches");
  if (controls.mode() == NavigationMode::fly)
    aside(
        fmt::format("Speed: {:.3g} units per second; change it with the wheel.", controls.speed()));
}

/// In the order of the keys 1 to 9, with the page's names.
void named_view_buttons(CameraControls& controls) {
  static constexpr const char* titles[] = {"Front",  "Back",   "Left",        "Right",      "Top",
                                           "Bottom", "Corner", "Corner left", "Corner back"};
  static_assert(std::size(titles) == std::size(named_views));
  for (std::size_t i = 0; i < std::size(titles); ++i) {
    if (i % 3 != 0) ImGui::SameLine();
    const float width = share_of_row(3 - int(i % 3));
    if (button(titles[i], width)) {
      controls.set_mode(NavigationMode::orbit);
      controls.look_from(named_views[i]);
    }
    tip(fmt::format("{}", i + 1));
  }
}

void up_menu(State& state) {
  CameraControls& controls = state.controls;
  field("Up");
  if (ImGui::BeginCombo("##up", axis_name(controls.up()).c_str())) {
    for (const glm::dvec3& axis : up_axes)
      if (list_item(axis_name(axis), is_axis(controls.up(), axis))) controls.set_up(axis);
    ImGui::EndCombo();
  }
  tip(describe(state.source.up) + ". U changes it, R restores it");
}

void recorded_slider(State& state) {
  const auto cameras = state.recorded_cameras();
  if (cameras.empty()) return;
  int index = std::min(state.recorded, int(cameras.size()) - 1);
  // The slider needs a printf format, but names come from files, so "%" is escaped.
  std::string name = index < 0 ? "recorded cameras: none" : fmt::format("{}: ", index);
  if (index >= 0)
    for (const char letter : cameras[std::size_t(index)]->name)
      name += letter == '%' ? std::string("%%") : std::string(1, letter);
  const float side = ImGui::GetFrameHeight();
  if (button("<", side)) run_shortcut(Key::left_bracket, With::nothing, state);
  tip("[: previous camera");
  ImGui::SameLine();
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - side -
                          ImGui::GetStyle().ItemSpacing.x);
  if (ImGui::SliderInt("##recorded", &index, 0, int(cameras.size()) - 1, name.c_str(),
                       ImGuiSliderFlags_AlwaysClamp))
    state.ask(ShowRecorded{index});
  tip("The cameras of the dataset, or of the scene");
  ImGui::SameLine();
  if (button(">", side)) run_shortcut(Key::right_bracket, With::nothing, state);
  tip("]: next camera");
}

}  // namespace

void view_panel(State& state) {
  CameraControls& controls = state.controls;
  mode_buttons(controls);
  named_view_buttons(controls);
  const float quarter = share_of_row(4);
  if (button("Frame all", quarter)) run_shortcut(Key::f, With::nothing, state);
  tip("F: frame the whole scene");
  ImGui::SameLine();
  if (button("First view", quarter)) run_shortcut(Key::r, With::nothing, state);
  tip("R: return to the first view");
  ImGui::SameLine();
  if (button("Keep as first view", share_of_row(1))) {
    state.edit(ChangeFirstView{controls.camera(state.pixels.x, state.pixels.y)});
    state.note("This view is now the first one. A saved .glb file keeps it.");
  }
  tip("Shows this view first, here and in a saved .glb file");
  up_menu(state);
  auto fov = static_cast<float>(controls.fov() * degrees_per_radian);
  field("Angle");
  if (ImGui::SliderFloat("##angle", &fov, 5, 120, "%.1f\u00b0", ImGuiSliderFlags_AlwaysClamp))
    controls.set_fov(fov / degrees_per_radian);
  recorded_slider(state);
  const glm::dvec3 eye = controls.eye();
  fact("Eye", fmt::format("{:.5g}, {:.5g}, {:.5g}", eye.x, eye.y, eye.z));
}

}  // namespace tureen::viewer
