#include "viewer/panels.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "viewer/gui/item_places.hpp"
#include "viewer/panels/widgets.hpp"

namespace tureen::viewer {

namespace {

/// In font heights, so that it scales with the font.
constexpr float column_width = 23;

/// The name of a section over the whole card, with an arrow. A click opens or closes the section.
/// Returns whether it is open.
bool section_header(const char* title, bool first_open) {
  const float padding = card_padding();
  const ImVec2 low = ImGui::GetCursorScreenPos();
  const ImVec2 size{ImGui::GetContentRegionAvail().x + 2 * padding,
                    ImGui::GetFrameHeight() + 0.4f * padding};
  ImGui::SetCursorScreenPos({low.x - padding, low.y});
  bool& open = *ImGui::GetStateStorage()->GetBoolRef(ImGui::GetID("open"), first_open);
  if (ImGui::InvisibleButton("header", size)) open = !open;
  note_item(std::string("section: ") + title);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 from = ImGui::GetItemRectMin(), to = ImGui::GetItemRectMax();
  if (ImGui::IsItemHovered())
    list.AddRectFilled(from, to, ImGui::GetColorU32(ImGuiCol_HeaderHovered),
                       ImGui::GetStyle().WindowRounding,
                       open ? ImDrawFlags_RoundCornersTop : ImDrawFlags_RoundCornersAll);
  const float middle = 0.5f * (from.y + to.y);
  {
    const Bold bold;
    list.AddText({low.x, std::floor(middle - 0.5f * ImGui::GetFontSize())},
                 ImGui::GetColorU32(ImGuiCol_Text), title);
  }
  const float arm = 0.25f * ImGui::GetFontSize(), direction = open ? -1.0f : 1.0f;
  const float x = to.x - padding - arm, y = middle - 0.5f * direction * arm;
  const ImVec2 arrow[] = {{x - arm, y}, {x, y + direction * arm}, {x + arm, y}};
  list.AddPolyline(arrow, 3, ImGui::GetColorU32(ImGuiCol_TextDisabled), 0,
                   0.1f * ImGui::GetFontSize());
  return open;
}

template <class Draw>
void section(const char* title, bool open, Draw draw) {
  const float padding = card_padding();
  ImGui::PushID(title);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  // The card lies behind its contents, which determine its height.
  list.ChannelsSplit(2);
  list.ChannelsSetCurrent(1);
  const ImVec2 low = ImGui::GetCursorScreenPos();
  const float right = low.x + ImGui::GetContentRegionAvail().x + padding;
  const float gap = ImGui::GetStyle().ItemSpacing.y;
  if (section_header(title, open)) {
    draw();
    ImGui::SetCursorPosY(ImGui::GetCursorPosY() + padding - gap);
  } else {
    ImGui::SetCursorPosY(ImGui::GetCursorPosY() - gap);
  }
  list.ChannelsSetCurrent(0);
  list.AddRectFilled({low.x - padding, low.y}, {right, ImGui::GetCursorScreenPos().y},
                     ImGui::GetColorU32(ImGuiCol_PopupBg), ImGui::GetStyle().WindowRounding);
  list.ChannelsMerge();
  ImGui::Dummy({0, 0});
  ImGui::PopID();
}

void scene_tab(State& state) {
  section("Scene", true, [&] { scene_panel(state); });
  if (state.training) section("Training", true, [&] { training_panel(state); });
  section("Layers", true, [&] { layers_panel(state); });
}

void drawing_tab(State& state, const FrameClock& clock) {
  section("Debug view", true, [&] { debug_view_panel(state); });
  section("Drawing", true, [&] { drawing_panel(state); });
  section("Frame times", false, [&] { times_panel(state, clock); });
  section("Window", true, [&] { window_panel(state); });
}

void camera_tab(State& state) {
  section("View", true, [&] { view_panel(state); });
  if (state.photographs) {
    ImGui::PushID("dataset");  // it opens, whether the section below was open or not
    section("Photographs", true, [&] { comparison_panel(state); });
    ImGui::PopID();
  }
  section("Image", true, [&] { image_panel(state); });
  if (!state.photographs) section("Photographs", false, [&] { comparison_panel(state); });
  section("Camera path", false, [&] { path_panel(state); });
}

}  // namespace

double panels_width(const State& state, double window_width) {
  if (!state.stage || !state.show_interface) return 0;
  // In a narrow window, half of the width remains for the image.
  return std::floor(std::min(double(column_width) * ImGui::GetFontSize(), 0.5 * window_width));
}

void draw_panels(State& state, const FrameClock& clock) {
  if (!ImGui::IsAnyItemActive()) ++state.gesture;
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  const auto width = static_cast<float>(panels_width(state, window.x));
  if (width <= 0) return;
  ImGui::SetNextWindowPos({window.x - width, 0});
  ImGui::SetNextWindowSize({width, window.y});
  const float padding = 2 * card_padding();
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(padding, 0.5f * padding));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0.0f);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0f);
  ImGui::PushStyleColor(ImGuiCol_WindowBg, color_of(palette(state.theme).page));
  ImGui::Begin("panels", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus);
  // Popups have the theme's own style.
  ImGui::PopStyleColor();
  ImGui::PopStyleVar(3);
  static constexpr const char* tabs[] = {"Scene", "Drawing", "Camera"};
  int tab = int(state.tab);
  segments("tab", tabs, tab);
  state.tab = PanelTab(tab);
  // Each scrolls on its own. The cards reach into the padding.
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(padding, 0));
  ImGui::SetCursorPosX(0);
  ImGui::BeginChild(tabs[tab], {width, 0}, false, ImGuiWindowFlags_AlwaysUseWindowPadding);
  ImGui::PopStyleVar();
  switch (state.tab) {
    case PanelTab::scene:
      scene_tab(state);
      break;
    case PanelTab::drawing:
      drawing_tab(state, clock);
      break;
    case PanelTab::camera:
      camera_tab(state);
      break;
  }
  ImGui::EndChild();
  ImGui::End();
}

void draw_overlays(State& state) {
  if (!state.stage) welcome_overlay(state);
  traced_overlay(state);
  if (state.stage) photograph_overlay(state);
  if (state.stage) gizmo_overlay(state);
  if (state.show_interface) status_overlay(state);
  progress_overlay(state);
  message_overlay(state);
  if (state.show_files) files_overlay(state);
  if (state.show_keys) keys_overlay(state);
  cameras_dialog(state);
  training_dialogs(state);
  saving_dialogs(state);
}

}  // namespace tureen::viewer
