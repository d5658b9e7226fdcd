// Widgets that several panels use.
#pragma once

#include <fmt/format.h>
#include <imgui/imgui.h>

#include <glm/vec4.hpp>
#include <string>
#include <utility>

#include "image/heat_map.hpp"

namespace tureen::viewer {

template <class... Args>
void text(fmt::format_string<Args...> format, Args&&... args) {
  const std::string line = fmt::format(format, std::forward<Args>(args)...);
  ImGui::TextUnformatted(line.data(), line.data() + line.size());
}

/// Text that wraps between words at the panel's edge.
inline void paragraph(const std::string& words) {
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(words.data(), words.data() + words.size());
  ImGui::PopTextWrapPos();
}

/// Dimmed text, for explanations and missing data.
inline void aside(const std::string& words) {
  ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
  paragraph(words);
  ImGui::PopStyleColor();
}

/// A tooltip of the previous item.
inline void tip(const std::string& words) {
  if (!ImGui::IsItemHovered()) return;
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(24 * ImGui::GetFontSize());
  ImGui::TextUnformatted(words.data(), words.data() + words.size());
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

/// The legend of colours, one row each.
inline void legend_rows(const Legend& legend) {
  for (const LegendEntry& entry : legend) {
    const glm::vec4 color = glm::vec4(entry.color) / 255.0f;
    ImGui::ColorButton(entry.text.c_str(), {color.r, color.g, color.b, 1},
                       ImGuiColorEditFlags_NoTooltip | ImGuiColorEditFlags_NoDragDrop,
                       {ImGui::GetFontSize(), ImGui::GetFontSize()});
    ImGui::SameLine();
    text("{}", entry.text);
  }
}

/// Disables and greys the items drawn in its scope.
class Disabled {
 public:
  explicit Disabled(bool disabled) { ImGui::BeginDisabled(disabled); }
  ~Disabled() { ImGui::EndDisabled(); }
  Disabled(const Disabled&) = delete;
  Disabled& operator=(const Disabled&) = delete;
};

}  // namespace tureen::viewer
