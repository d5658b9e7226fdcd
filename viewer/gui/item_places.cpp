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
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  // Not in the middle: wide rows may have other controls there.
  const float right = std::min(0.5f * (high.x - low.x), ImGui::GetFontSize());
  const ImVec2 place{low.x + right, 0.5f * (low.y + high.y)};
  if (ImGui::IsRectVisible(place, {place.x + 1, place.y + 1})) noted()[name] = {place.x, place.y};
}

void note_field(const std::string& name) {
  const ImVec2 low = ImGui::GetCursorScreenPos();
  const ImVec2 place{low.x + ImGui::GetFontSize(), low.y + 0.5f * ImGui::GetFrameHeight()};
  if (ImGui::IsRectVisible(place, {place.x + 1, place.y + 1})) noted()[name] = {place.x, place.y};
}

void note_place(const std::string& name, const glm::dvec2& place) { noted()[name] = place; }

void end_item_notes() { shown() = std::exchange(noted(), {}); }

std::optional<glm::dvec2> item_place(const std::string& name) {
  const auto found = shown().find(name);
  return found == shown().end() ? std::nullopt : std::optional(found->second);
}

}  // namespace tureen::viewer
