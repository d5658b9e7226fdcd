// Draws the photograph or the map of differences over its part of the image.
#include <algorithm>
#include <cmath>

#include "viewer/panels.hpp"
#include "viewer/panels/widgets.hpp"

namespace tureen::viewer {

namespace {

/// Distance from the divider within which a drag moves it, in points.
constexpr float grip = 6;

/// Moves the divider by a drag. Returns its position in points. `window`: size of the image.
float divider(Comparison& comparison, ImVec2 window) {
  const auto x = static_cast<float>(comparison.divider) * window.x;
  ImGui::SetNextWindowPos({x - grip, 0});
  ImGui::SetNextWindowSize({2 * grip, window.y});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1, 1));
  ImGui::Begin("divider", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoBackground |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoBringToFrontOnFocus);
  ImGui::InvisibleButton("grip", {2 * grip, window.y});
  if (ImGui::IsItemHovered() || ImGui::IsItemActive())
    ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
  if (ImGui::IsItemActive())
    comparison.divider = std::clamp(double(ImGui::GetIO().MousePos.x) / window.x, 0.0, 1.0);
  ImGui::End();
  ImGui::PopStyleVar(2);
  return static_cast<float>(comparison.divider) * window.x;
}

/// A short text at the bottom of the image. `align`: the part of it that lies left of x, 0..1.
void tag(const char* words, float x, float align, Theme theme) {
  const Palette& colors = palette(theme);
  const float em = ImGui::GetFontSize();
  const ImVec2 text = ImGui::CalcTextSize(words);
  const ImVec2 padding{0.6f * em, 0.3f * em};
  const ImVec2 size{text.x + 2 * padding.x, text.y + 2 * padding.y};
  const ImVec2 low{std::floor(x - align * size.x),
                   ImGui::GetIO().DisplaySize.y - size.y - 2.5f * em};
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  list.AddRectFilled(low, {low.x + size.x, low.y + size.y},
                     ImGui::GetColorU32(color_of(colors.card)), ImGui::GetStyle().WindowRounding);
  list.AddText({low.x + padding.x, low.y + padding.y}, ImGui::GetColorU32(ImGuiCol_Text), words);
}

}  // namespace

void photograph_overlay(State& state) {
  Comparison& comparison = state.comparison;
  if (!state.photographs || comparison.show == Comparison::Show::off) return;
  const Photograph* photograph = state.photograph();
  if (!photograph) {
    tag("No photograph has this view: [ and ] select one", 0.5f * float(state.points.x), 0.5f,
        state.theme);
    return;
  }
  const ImVec2 window{float(state.points.x), float(state.points.y)};
  const double points_per_pixel = double(state.points.x) / state.pixels.x;
  const PlacedPhotograph placed = place(
      photograph->camera, state.controls.camera(state.pixels.x, state.pixels.y), points_per_pixel);
  const ImVec2 low{float(placed.low.x), float(placed.low.y)};
  const ImVec2 high{float(placed.high.x), float(placed.high.y)};
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const bool difference = comparison.show == Comparison::Show::difference;
  const bool split = comparison.show == Comparison::Show::split;
  const ImageTexture* texture = &comparison.texture;
  if (difference) {
    if (!comparison.result) return;
    texture = &comparison.result->difference;
  }
  if (!*texture) return;
  const float edge = split ? divider(comparison, window) : window.x;
  list.PushClipRect({0, 0}, {edge, window.y});
  // Transparent parts of the photograph show the scene's background.
  const glm::vec3 back = background_of(state.source);
  list.AddRectFilled(low, high, ImGui::GetColorU32(ImVec4(back.r, back.g, back.b, 1)));
  list.AddImage(texture->id(), low, high);
  list.PopClipRect();
  if (!split) return;
  list.AddLine({edge, 0}, {edge, window.y}, IM_COL32(255, 255, 255, 160), 1.5f);
  tag("Photograph", edge - grip, 1, state.theme);
  tag("Scene", edge + grip, 0, state.theme);
}

}  // namespace tureen::viewer
