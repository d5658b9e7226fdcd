#include "viewer/gui/item_places.hpp"

#include <imgui/imgui.h>

#include <algorithm>
#include <map>
#include <utility>

namespace tureen::viewer {

namespace {

using Places = std::map<std::string, glm::dvec2>;

// As Dear ImGui, which has one interface for a program.
Places& noted() {
  static Places places;
  return places;
}
Places& shown() {
  static Places places;
  return places;
}

}  // namespace

void note_item(const std::string& name) {
  if (!ImGui::IsItemVisible()) return;
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  // Not in the middle: wide rows may have other controls there.
  const float right = std::min(0.5f * (high.x - low.x), ImGui::GetFontSize());
  noted()[name] = {low.x + right, 0.5f * (low.y + high.y)};
}

void note_field(const std::string& name) {
  const float em = ImGui::GetFontSize(), height = ImGui::GetFrameHeight();
  if (!ImGui::IsRectVisible({em, height})) return;
  const ImVec2 low = ImGui::GetCursorScreenPos();
  noted()[name] = {low.x + em, low.y + 0.5f * height};
}

void note_place(const std::string& name, const glm::dvec2& place) { noted()[name] = place; }

void end_item_notes() { shown() = std::exchange(noted(), {}); }

std::optional<glm::dvec2> item_place(const std::string& name) {
  const auto found = shown().find(name);
  return found == shown().end() ? std::nullopt : std::optional(found->second);
}

}  // namespace tureen::viewer
