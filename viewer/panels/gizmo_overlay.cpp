// The gizmo over the selected layer.
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "viewer/gui/item_places.hpp"
#include "viewer/panels.hpp"
#include "viewer/panels/widgets.hpp"
#include "viewer/scene/gizmo.hpp"

namespace tureen::viewer {

namespace {

using Kind = GizmoHandle::Kind;

// In points: distance from a handle within which a press drags it, length of an arrow, and width of
// lines.
constexpr double reach = 8, arm_points = 84;
constexpr float thick = 3, thin = 1.5f;

constexpr std::uint32_t axis_colors[] = {0xe5484d, 0x46a758, 0x4c8dff};

ImVec2 point_of(const glm::dvec2& at) { return {float(at.x), float(at.y)}; }

ImU32 color_for(const GizmoHandle& handle, bool lit, float alpha = 1) {
  ImVec4 color = color_of(lit                         ? 0xffc53d
                          : handle.kind == Kind::size ? 0xe7e9ef
                                                      : axis_colors[handle.axis]);
  color.w = alpha;
  return ImGui::GetColorU32(color);
}

void draw_handle(ImDrawList& list, const GizmoHandle& handle, bool lit) {
  std::vector<ImVec2> points;
  for (const glm::dvec2& each : handle.shape) points.push_back(point_of(each));
  const ImU32 color = color_for(handle, lit);
  if (handle.kind == Kind::plane) {
    list.AddConvexPolyFilled(points.data(), int(points.size()), color_for(handle, lit, 0.45f));
    list.AddPolyline(points.data(), int(points.size()), color, ImDrawFlags_Closed, thin);
    return;
  }
  // A dark edge: the scene may have any colour.
  list.AddPolyline(points.data(), int(points.size()), IM_COL32(0, 0, 0, 110), 0, thick + 2);
  list.AddPolyline(points.data(), int(points.size()), color, 0, thick);
  if (handle.kind != Kind::axis) return;
  const glm::dvec2 tip = handle.shape.back(), way = tip - handle.shape.front();
  const double length = std::max(std::hypot(way.x, way.y), 1e-6);
  const glm::dvec2 ahead = way / length * 12.0, aside(-0.45 * ahead.y, 0.45 * ahead.x);
  list.AddTriangleFilled(point_of(tip + ahead), point_of(tip + aside), point_of(tip - aside),
                         color);
}

void draw_words(ImDrawList& list, const std::string& words, ImVec2 at, Theme theme) {
  const ImVec2 size = ImGui::CalcTextSize(words.c_str());
  const float padding = 0.3f * ImGui::GetFontSize();
  const ImVec2 low{at.x + 2 * padding + 10, at.y - size.y};
  list.AddRectFilled(
      {low.x - padding, low.y - padding}, {low.x + size.x + padding, low.y + size.y + padding},
      ImGui::GetColorU32(color_of(palette(theme).card)), ImGui::GetStyle().FrameRounding);
  list.AddText(low, ImGui::GetColorU32(ImGuiCol_Text), words.c_str());
}

/// A small window under the pointer, which takes the press from the scene. Begins, continues and
/// ends the drag.
void follow_pointer(State& state, const DocumentLayer& layer, const Gizmo& gizmo,
                    const GizmoHandle* hovered) {
  GizmoState& now = state.gizmo;
  const ImVec2 pointer = ImGui::GetIO().MousePos;
  const float side = 2 * float(reach);
  ImGui::SetNextWindowPos({pointer.x - float(reach), pointer.y - float(reach)});
  ImGui::SetNextWindowSize({side, side});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1, 1));
  ImGui::Begin("gizmo", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoBackground |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoBringToFrontOnFocus);
  ImGui::InvisibleButton("grip", {side, side});
  const glm::dvec2 at(pointer.x, pointer.y);
  if (ImGui::IsItemActivated() && hovered)
    now.drag = GizmoDrag{gizmo, *hovered, at, layer.world_from_layer, layer.id};
  if (!ImGui::IsItemActive()) now.drag.reset();
  ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeAll);
  ImGui::End();
  ImGui::PopStyleVar(2);
  if (!now.drag) return;
  const auto change =
      change_of(*now.drag, at, ImGui::GetIO().KeyCtrl ? Snapping::on : Snapping::off);
  if (!change) return;
  if (change->world_from_layer != layer.world_from_layer)
    state.edit(PlaceLayer{layer.id, change->world_from_layer}, true);
  draw_words(*ImGui::GetForegroundDrawList(), change->text, pointer, state.theme);
}

}  // namespace

void gizmo_overlay(State& state) {
  GizmoState& now = state.gizmo;
  const bool hovered_before = std::exchange(now.is_hovered, false);
  const DocumentLayer& layer = state.selected_layer();
  if (now.drag && now.drag->layer != layer.id) now.drag.reset();  // another one was selected
  if (now.tool == GizmoTool::off || !layer.visible || !state.show_interface ||
      state.animation.plays)
    return now.drag.reset();
  const auto gizmo =
      gizmo_of(layer, now.axes, state.controls.camera(state.points.x, state.points.y), arm_points);
  if (!gizmo) return now.drag.reset();
  const std::vector<GizmoHandle> handles = gizmo->handles(now.tool);
  const ImGuiIO& io = ImGui::GetIO();
  std::optional<std::size_t> hovered;
  // The pointer belongs to the panel, or to a drag of the view.
  const bool is_free = hovered_before || !(io.WantCaptureMouse || ImGui::IsAnyMouseDown());
  if (!now.drag && is_free && io.MousePos.x < float(state.points.x))
    hovered = handle_at(handles, {io.MousePos.x, io.MousePos.y}, reach);
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  list.PushClipRect({0, 0}, {float(state.points.x), float(state.points.y)});
  for (std::size_t i = 0; i < handles.size(); ++i) {
    const GizmoHandle& handle = handles[i];
    const bool dragged =
        now.drag && now.drag->handle.kind == handle.kind && now.drag->handle.axis == handle.axis;
    draw_handle(list, handle, dragged || hovered == i);
    note_place("gizmo: " + std::string(handle.kind == Kind::size ? "size" : "") +
                   (handle.kind == Kind::plane ? "across " : "") +
                   (handle.kind == Kind::size ? "" : std::string(1, char('x' + handle.axis))),
               handle.kind == Kind::plane ? 0.5 * (handle.shape[0] + handle.shape[2])
                                          : handle.shape[handle.shape.size() / 2]);
  }
  list.PopClipRect();
  if (now.drag || hovered) {
    now.is_hovered = true;
    follow_pointer(state, layer, *gizmo, hovered ? &handles[*hovered] : nullptr);
  }
}

}  // namespace tureen::viewer
