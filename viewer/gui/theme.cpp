#include "viewer/gui/theme.hpp"

#include <imgui/imgui.h>

#include <algorithm>
#include <iterator>

#include "viewer/gui/colors.hpp"

namespace tureen::viewer {

namespace {

constexpr Palette light{.page = 0xf5f4f0,
                        .card = 0xfffefb,
                        .tint = 0xeceae3,
                        .line = 0xd9d6cc,
                        .edge = 0x8b8778,
                        .ink = 0x1c2230,
                        .faint = 0x5a6070,
                        .accent = 0x2b50a8,
                        .on_accent = 0xffffff,
                        .accent_tint = 0xe3e9f7,
                        .danger = 0xa02c2c,
                        .danger_tint = 0xfbeaea};
constexpr Palette dark{.page = 0x12151c,
                       .card = 0x1a1e27,
                       .tint = 0x242935,
                       .line = 0x2d3340,
                       .edge = 0x697184,
                       .ink = 0xe7e9ef,
                       .faint = 0x9da5b5,
                       .accent = 0x9db8ff,
                       .on_accent = 0x0f1730,
                       .accent_tint = 0x26335a,
                       .danger = 0xff9d97,
                       .danger_tint = 0x3a1f22};

}  // namespace

const Palette& palette(Theme theme) { return theme == Theme::light ? light : dark; }

void set_colors(Theme theme) {
  const Palette& of = palette(theme);
  ImGui::StyleColorsDark();  // for the colours that nothing here uses
  ImGuiStyle& style = ImGui::GetStyle();
  const auto set = [&style](std::uint32_t color, auto... which) {
    ((style.Colors[which] = color_of(color)), ...);
  };
  set(of.ink, ImGuiCol_Text);
  set(of.faint, ImGuiCol_TextDisabled);
  set(of.card, ImGuiCol_WindowBg, ImGuiCol_PopupBg, ImGuiCol_FrameBg, ImGuiCol_TitleBg,
      ImGuiCol_TitleBgActive, ImGuiCol_TitleBgCollapsed);
  set(of.edge, ImGuiCol_Border, ImGuiCol_ScrollbarGrabHovered, ImGuiCol_ScrollbarGrabActive);
  set(of.line, ImGuiCol_Separator, ImGuiCol_ScrollbarGrab);
  set(of.tint, ImGuiCol_Button);
  set(of.accent_tint, ImGuiCol_FrameBgHovered, ImGuiCol_FrameBgActive, ImGuiCol_ButtonHovered,
      ImGuiCol_ButtonActive, ImGuiCol_Header, ImGuiCol_HeaderHovered, ImGuiCol_HeaderActive,
      ImGuiCol_TextSelectedBg);
  set(of.accent, ImGuiCol_CheckMark, ImGuiCol_SliderGrab, ImGuiCol_SliderGrabActive,
      ImGuiCol_PlotLines, ImGuiCol_PlotHistogram, ImGuiCol_PlotHistogramHovered,
      ImGuiCol_NavHighlight, ImGuiCol_SeparatorHovered, ImGuiCol_SeparatorActive);
  style.Colors[ImGuiCol_ScrollbarBg] = style.Colors[ImGuiCol_ChildBg] = {0, 0, 0, 0};
  style.Colors[ImGuiCol_ModalWindowDimBg] = {0, 0, 0, 0.45f};
  style.Colors[ImGuiCol_ResizeGrip] = color_of(of.line);
  style.Colors[ImGuiCol_ResizeGripHovered] = style.Colors[ImGuiCol_ResizeGripActive] =
      color_of(of.edge);
}

void set_shapes(double scale) {
  // In points at scale 1, close to those of the page.
  ImGuiStyle style;
  style.WindowRounding = 10;
  style.ChildRounding = style.FrameRounding = style.PopupRounding = 8;
  style.GrabRounding = style.ScrollbarRounding = 6;
  style.WindowBorderSize = style.PopupBorderSize = style.FrameBorderSize = 1;
  style.WindowPadding = {14, 12};
  style.FramePadding = {9, 5};
  style.ItemSpacing = {8, 8};
  style.ItemInnerSpacing = {8, 6};
  style.ScrollbarSize = 10;
  style.GrabMinSize = 14;
  style.WindowTitleAlign = {0, 0.5f};
  style.ScaleAllSizes(static_cast<float>(scale));
  std::copy(std::begin(ImGui::GetStyle().Colors), std::end(ImGui::GetStyle().Colors),
            std::begin(style.Colors));
  ImGui::GetStyle() = style;
}

}  // namespace tureen::viewer
