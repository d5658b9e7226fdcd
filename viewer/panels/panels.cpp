#include "viewer/panels.hpp"

#include <algorithm>
#include <cmath>

#include "viewer/panels/widgets.hpp"

namespace tureen::viewer {

namespace {

/// In font heights, so that it scales with the font. Wide enough for a line of the plan.
constexpr float column_width = 25;

template <class Draw>
void section(const char* title, bool open, Draw draw) {
  if (!ImGui::CollapsingHeader(title, open ? ImGuiTreeNodeFlags_DefaultOpen : 0)) return;
  ImGui::PushID(title);
  ImGui::Indent(4);
  draw();
  ImGui::Unindent(4);
  ImGui::PopID();
  ImGui::Spacing();
}

}  // namespace

double panels_width(const State& state, double window_width) {
  if (!state.stage || !state.show_interface) return 0;
  // In a narrow window, half of the width remains for the image.
  return std::floor(std::min(double(column_width) * ImGui::GetFontSize(), 0.5 * window_width));
}

void draw_panels(State& state, const FrameClock& clock) {
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  const auto width = static_cast<float>(panels_width(state, window.x));
  if (width <= 0) return;
  ImGui::SetNextWindowPos({window.x - width, 0});
  ImGui::SetNextWindowSize({width, window.y});
  ImGui::Begin("panels", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus);
  section("Scene", true, [&] { scene_panel(state); });
  if (state.training) section("Training", true, [&] { training_panel(state); });
  // A single unchanged layer needs no list.
  if (state.stage->layers.size() > 1 || !state.stage->is_as_read())
    section("Layers", true, [&] { layers_panel(state); });
  section("View", true, [&] { view_panel(state); });
  section("Debug view", true, [&] { debug_view_panel(state); });
  section("Drawing", false, [&] { drawing_panel(state); });
  section("Photographs", false, [&] { comparison_panel(state); });
  section("Images", false, [&] { image_panel(state); });
  section("Camera path", false, [&] { path_panel(state); });
  section("Frame times", false, [&] { times_panel(state, clock); });
  ImGui::End();
}

void draw_overlays(State& state) {
  if (!state.stage) welcome_overlay(state);
  if (state.stage) photograph_overlay(state);
  if (state.show_interface) status_overlay(state);
  message_overlay(state);
  if (state.show_files) files_overlay(state);
  if (state.show_keys) keys_overlay(state);
}

}  // namespace tureen::viewer
