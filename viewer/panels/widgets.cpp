#include "viewer/panels/widgets.hpp"

#include <imgui/imgui_internal.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <glm/vec4.hpp>

#include "viewer/gui/item_places.hpp"

namespace tureen::viewer {

namespace {

/// Width of the column of labels, in font heights: "GPU memory" and a space.
constexpr float label_width = 6.2f;

/// Changes a colour of the style in its scope.
struct StyleColor : Scope<[] { ImGui::PopStyleColor(); }> {
  StyleColor(ImGuiCol which, const ImVec4& color) { ImGui::PushStyleColor(which, color); }
};

/// Changes a number or a distance of the style in its scope.
struct StyleVar : Scope<[] { ImGui::PopStyleVar(); }> {
  StyleVar(ImGuiStyleVar which, const auto& value) { ImGui::PushStyleVar(which, value); }
};

ImVec4 style_color(ImGuiCol which) { return ImGui::GetStyleColorVec4(which); }

/// `index`: in the order of add_fonts() (viewer/gui/font.hpp). Dear ImGui's own font is the only
/// one.
void push_font(int index) {
  const ImVector<ImFont*>& fonts = ImGui::GetIO().Fonts->Fonts;
  ImGui::PushFont(fonts[index < fonts.Size ? index : 0]);
}

void unformatted(const std::string& words) {
  ImGui::TextUnformatted(words.data(), words.data() + words.size());
}

/// A button without a frame's border: only fields have one.
bool plain_button(const char* label, ImVec2 size) {
  const StyleVar border(ImGuiStyleVar_FrameBorderSize, 0.0f);
  const bool pressed = ImGui::Button(label, size);
  note_item(label);
  return pressed;
}

/// Draws a label of the column and moves to its control.
void label(const char* words) {
  const float left = ImGui::GetCursorPosX();
  ImGui::PushStyleColor(ImGuiCol_Text, style_color(ImGuiCol_TextDisabled));
  ImGui::TextUnformatted(words);
  ImGui::PopStyleColor();
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  ImGui::SameLine(left +
                  std::max(label_width * ImGui::GetFontSize(), ImGui::GetItemRectSize().x + gap));
}

}  // namespace

void paragraph(const std::string& words) {
  ImGui::PushTextWrapPos(0);
  unformatted(words);
  ImGui::PopTextWrapPos();
}

void aside(const std::string& words) {
  const StyleColor dimmed(ImGuiCol_Text, style_color(ImGuiCol_TextDisabled));
  paragraph(words);
}

void sentence(std::string words) {
  if (!words.empty() && words.front() >= 'a' && words.front() <= 'z') words.front() -= 'a' - 'A';
  aside(words);
}

void heading(const std::string& words) {
  const Bold bold;
  aside(words);
}

void fact(const char* name, const std::string& value) {
  label(name);
  paragraph(value);
}

void tip(const std::string& words) {
  if (!ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return;
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(24 * ImGui::GetFontSize());
  unformatted(words);
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

void legend_rows(const Legend& legend) {
  for (const LegendEntry& entry : legend) {
    const glm::vec4 color = glm::vec4(entry.color) / 255.0f;
    ImGui::ColorButton(entry.text.c_str(), {color.r, color.g, color.b, 1},
                       ImGuiColorEditFlags_NoTooltip | ImGuiColorEditFlags_NoDragDrop,
                       {ImGui::GetFontSize(), ImGui::GetFontSize()});
    ImGui::SameLine();
    text("{}", entry.text);
  }
}

void field(const char* name) {
  ImGui::AlignTextToFramePadding();
  label(name);
  note_field(name);
  ImGui::SetNextItemWidth(-FLT_MIN);
}

bool button(const char* name) { return plain_button(name, {0, 0}); }

bool button(const char* name, float width) {
  // The width is given, so the text may come close to the edge.
  const ImVec2 padding = ImGui::GetStyle().FramePadding;
  const StyleVar narrow(ImGuiStyleVar_FramePadding, ImVec2(0.2f * padding.x, padding.y));
  return plain_button(name, {width, 0});
}

void beside(const char* label) {
  const ImGuiStyle& style = ImGui::GetStyle();
  const float right = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
  const float width = ImGui::CalcTextSize(label).x + 2 * style.FramePadding.x;
  if (ImGui::GetItemRectMax().x + style.ItemSpacing.x + width <= right) ImGui::SameLine();
}

bool small_button(const char* name) {
  const StyleVar border(ImGuiStyleVar_FrameBorderSize, 0.0f);
  const bool pressed = ImGui::SmallButton(name);
  note_item(name);
  return pressed;
}

bool strong_button(const char* name) {
  const ImVec4 accent = style_color(ImGuiCol_CheckMark);
  const StyleColor at_rest(ImGuiCol_Button, accent), hovered(ImGuiCol_ButtonHovered, accent),
      active(ImGuiCol_ButtonActive, accent), letters(ImGuiCol_Text, style_color(ImGuiCol_FrameBg));
  const Bold bold;
  return plain_button(name, {0, 0});
}

float share_of_row(int count) {
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  return std::floor((ImGui::GetContentRegionAvail().x - gap * float(count - 1)) / float(count));
}

bool check(const char* name, bool* on) {
  // The square is as high as a line, so that rows of text and of switches have one rhythm.
  const ImGuiStyle& style = ImGui::GetStyle();
  const StyleVar padding(ImGuiStyleVar_FramePadding, ImVec2(style.FramePadding.x, 1));
  const StyleVar rounding(ImGuiStyleVar_FrameRounding, 0.5f * style.FrameRounding);
  const bool changed = ImGui::Checkbox(name, on);
  note_item(name);
  return changed;
}

bool check_beside_field(const char* name, bool* on) {
  const float height = ImGui::GetTextLineHeight() + 2;  // of the square
  ImGui::SetCursorPosY(ImGui::GetCursorPosY() +
                       std::floor(0.5f * (ImGui::GetFrameHeight() - height)));
  return check(name, on);
}

bool segments(const char* id, std::span<const char* const> labels, int& chosen) {
  bool changed = false;
  const ImGuiStyle& style = ImGui::GetStyle();
  const float gap = 0.2f * ImGui::GetFontSize();  // around each button
  const ImVec2 low = ImGui::GetCursorScreenPos();
  const ImVec2 size{ImGui::GetContentRegionAvail().x, ImGui::GetFrameHeight() + 2 * gap};
  ImGui::GetWindowDrawList()->AddRectFilled(low, {low.x + size.x, low.y + size.y},
                                            ImGui::GetColorU32(ImGuiCol_Button),
                                            style.FrameRounding);
  const auto count = float(labels.size());
  const float equal = std::floor((size.x - gap * (count + 1)) / count);
  float texts = 0, longest = 0;
  for (const char* label : labels) {
    const float width = ImGui::CalcTextSize(label).x;
    texts += width;
    longest = std::max(longest, width);
  }
  const float spare = (size.x - gap * (count + 1) - texts) / count;
  float left = low.x + gap;
  ImGui::PushID(id);
  ImGui::BeginGroup();
  for (int i = 0; i < int(labels.size()); ++i) {
    const bool on = i == chosen;
    const float width = longest + gap <= equal
                            ? equal
                            : std::floor(ImGui::CalcTextSize(labels[std::size_t(i)]).x + spare);
    ImGui::SetCursorScreenPos({left, low.y + gap});
    left += width + gap;
    const StyleColor back(ImGuiCol_Button, on ? style_color(ImGuiCol_FrameBg) : ImVec4(0, 0, 0, 0));
    const StyleColor front(ImGuiCol_Text,
                           style_color(on ? ImGuiCol_CheckMark : ImGuiCol_TextDisabled));
    const bool pressed = button(labels[std::size_t(i)], width);
    note_item(std::string(id) + ": " + labels[std::size_t(i)]);
    if (pressed && !on) {
      chosen = i;
      changed = true;
    }
  }
  ImGui::SetCursorScreenPos(low);
  ImGui::Dummy(size);
  ImGui::EndGroup();
  ImGui::PopID();
  return changed;
}

bool list_item(const std::string& name, bool chosen) {
  const bool pressed = ImGui::Selectable(name.c_str(), chosen);
  note_item(name);
  return pressed;
}

void progress_bar(double fraction) {
  const float height = 0.4f * ImGui::GetFontSize();
  const ImVec2 low = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const auto bar = [&](float end, ImGuiCol color) {
    list.AddRectFilled(low, {low.x + end, low.y + height}, ImGui::GetColorU32(color),
                       0.5f * height);
  };
  bar(width, ImGuiCol_Separator);
  // Not shorter than its round ends.
  bar(std::max(width * float(std::clamp(fraction, 0.0, 1.0)), height), ImGuiCol_PlotHistogram);
  ImGui::Dummy({width, height});
}

bool escape_pressed() { return ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape), false); }

bool enter_pressed() {
  // Not in the frame in which a dialog opens: Enter in the dialog before may have opened it.
  return !ImGui::IsWindowAppearing() &&
         ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Enter), false);
}

Dialog::Dialog(const char* title, bool open) {
  if (open && !ImGui::IsPopupOpen(title)) ImGui::OpenPopup(title);
  // What lies behind is dim at once: the window draws no frames to fade it.
  if (open) ImGui::GetCurrentContext()->DimBgRatio = 1;
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  const float em = ImGui::GetFontSize();
  ImGui::SetNextWindowPos({0.5f * window.x, 0.45f * window.y}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSize({std::min(36 * em, window.x - 2 * em), 0});
  begun_ = ImGui::BeginPopupModal(
      title, nullptr,
      ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings);
  if (begun_ && !open) ImGui::CloseCurrentPopup();
  open_ = begun_ && open;
}

Dialog::~Dialog() {
  if (begun_) ImGui::EndPopup();
}

Card::Card(const Look& look)
    : look_(look), low_(ImGui::GetCursorScreenPos()), width_(ImGui::GetContentRegionAvail().x) {
  // The rectangle lies behind the items, which determine its height.
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.ChannelsSplit(2);
  list.ChannelsSetCurrent(1);
  ImGui::BeginGroup();
}

Card::~Card() {
  ImGui::EndGroup();
  const float padding = card_padding();
  const ImVec2 from{low_.x - padding, low_.y - padding};
  const ImVec2 to{low_.x + width_ + padding, ImGui::GetItemRectMax().y + padding};
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.ChannelsSetCurrent(0);
  list.PushClipRectFullScreen();  // the edge lies in the window's padding
  const float rounding = ImGui::GetStyle().WindowRounding;
  list.AddRectFilled(from, to, ImGui::GetColorU32(color_of(look_.color)), rounding);
  list.AddRect(from, to, ImGui::GetColorU32(color_of(look_.edge)), rounding);
  list.PopClipRect();
  list.ChannelsMerge();
  ImGui::Dummy({0, 2 * padding - ImGui::GetStyle().ItemSpacing.y});
}

float card_padding() { return 0.7f * ImGui::GetFontSize(); }

Bold::Bold() { push_font(1); }
Title::Title() { push_font(2); }

}  // namespace tureen::viewer
