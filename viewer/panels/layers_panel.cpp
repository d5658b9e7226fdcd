// The layers of the scene: visibility, order, removal, and the place and name of the selected one.
// clang-format off: the second header needs the first
#include <imgui/imgui.h>
#include <imgui/imgui_stdlib.h>
// clang-format on

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "base/decimal_text.hpp"
#include "viewer/gui/item_places.hpp"
#include "viewer/panels.hpp"
#include "viewer/panels/widgets.hpp"
#include "viewer/scene/placing.hpp"

namespace tureen::viewer {

namespace {

/// Smallest and largest scale.
constexpr double min_scale = 1e-6, max_scale = 1e6;
/// Largest index of refraction: that of germanium, in infrared light.
constexpr float max_ior = 4.0f;

/// Returns whether the layer was clicked.
bool layer_row(State& state, const DocumentLayer& layer, bool selected) {
  bool visible = layer.visible;
  if (check("##visible", &visible)) state.edit(ShowLayer{layer.id, visible});
  note_item("visible: " + layer.name);
  tip("Show");
  ImGui::SameLine();
  const std::string count = counted(primitive_count(layer));
  const float count_left = ImGui::GetContentRegionMax().x - ImGui::CalcTextSize(count.c_str()).x;
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  const bool clicked =
      ImGui::Selectable("##layer", selected, 0, {count_left - gap - ImGui::GetCursorPosX(), 0});
  note_item("layer: " + layer.name);
  const bool hovered = ImGui::IsItemHovered();
  // Not the label of the selectable: names come from files, and "##" has a meaning for Dear ImGui,
  // which enlarges the row by half the space between items.
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  const ImVec2 space = ImGui::GetStyle().ItemSpacing;
  ImDrawList& drawing = *ImGui::GetWindowDrawList();
  drawing.PushClipRect(low, high, true);
  drawing.AddText({low.x + std::floor(0.5f * space.x), low.y + std::floor(0.5f * space.y)},
                  ImGui::GetColorU32(ImGuiCol_Text), layer.name.data(),
                  layer.name.data() + layer.name.size());
  drawing.PopClipRect();
  if (hovered) ImGui::SetTooltip("%s", layer.name.c_str());
  ImGui::SameLine(count_left);
  text("{}", count);
  tip(soup_of(layer) ? "triangles" : "splats");
  return clicked;
}

/// Digits for lengths to about a thousandth of the scene's size: three such numbers fit in a row.
int length_digits(double radius) {
  return std::clamp(3 - int(std::floor(std::log10(radius))), 0, 12);
}

/// Three numbers to drag, or to type after a double click. What is below `noise` is shown as 0,
/// without a sign. Returns whether they changed.
bool numbers_row(const char* name, glm::dvec3& values, double speed, double noise,
                 const char* format) {
  glm::dvec3 shown = values;
  for (int i = 0; i < 3; ++i)
    if (std::abs(shown[i]) < noise) shown[i] = 0;
  const glm::dvec3 before = shown;
  field(name);
  if (!ImGui::DragScalarN(fmt::format("##{}", name).c_str(), ImGuiDataType_Double, &shown.x, 3,
                          float(speed), nullptr, nullptr, format))
    return false;
  for (int i = 0; i < 3; ++i)
    if (shown[i] != before[i]) values[i] = shown[i];
  return true;
}

/// Returns whether the numbers changed.
bool place_rows(Similarity& numbers, double radius) {
  const int digits = length_digits(radius);
  bool changed = numbers_row("Position", numbers.position, radius / 500,
                             0.5 * std::pow(10, -digits), fmt::format("%.{}f", digits).c_str());
  tip("Position in world units (x, y, z). Drag, or double-click to type");
  // Angles come from matrices, which round them.
  changed |= numbers_row("Rotation", numbers.angles, 0.5, 1e-6, "%.5g");
  tip("Degrees about the world's axes through the layer's origin: x, then y, then z; "
      "counter-clockwise, seen from the positive end of the axis");
  field("Scale");
  ImGui::SetNextItemWidth(5.5f * ImGui::GetFontSize());
  changed |=
      ImGui::DragScalar("##scale", ImGuiDataType_Double, &numbers.scale, float(numbers.scale / 200),
                        &min_scale, &max_scale, "%.6g", ImGuiSliderFlags_AlwaysClamp);
  ImGui::SameLine();
  changed |= check_beside_field("Mirror", &numbers.mirror);
  tip("Negates the layer's x, before the rotation");
  return changed;
}

void name_row(State& state, const DocumentLayer& layer) {
  std::string name = layer.name;
  field("Name");
  // A layer without a name would get that of its file.
  if (ImGui::InputText("##name", &name) && !name.empty())
    state.edit(RenameLayer{layer.id, name}, true);
}

void place_of(State& state, const DocumentLayer& layer) {
  LayerEditing& editing = state.layer_editing;
  if (editing.matrix != layer.world_from_layer) {
    editing.matrix = layer.world_from_layer;
    editing.numbers = similarity_of(editing.matrix);
  }
  if (!place_rows(editing.numbers, state.controls.radius())) return;
  const glm::dmat4 matrix = matrix_of(editing.numbers);
  // A typed number may be too large for a double.
  if (defect(Layer{.world_from_layer = matrix})) {
    editing.numbers = similarity_of(editing.matrix);
  } else {
    editing.matrix = matrix;
    state.edit(PlaceLayer{layer.id, matrix}, true);
  }
}

/// What rays see of a mesh.
void surface_row(State& state, const DocumentLayer& layer) {
  if (!soup_of(layer)) return;
  const Layer* const read = state.source.as_read(layer);
  const std::optional<Material> stored = read ? read->material : std::nullopt;
  const bool glass = layer.material && is_glass(*layer.material);
  constexpr const char* names[] = {"As stored", "Mirror", "Glass"};
  const int shown = layer.material == stored ? 0 : glass ? 2 : 1;
  int chosen = shown;
  field("Surface");
  if (ImGui::Combo("##surface", &chosen, names, int(std::size(names))) && chosen != shown)
    state.edit(SetMaterial{layer.id, chosen == 0   ? stored
                                     : chosen == 1 ? std::optional(mirror_material())
                                                   : glass_material(default_ior)});
  tip("For traced images: as the file stores it, a perfect mirror, or clear glass");
  if (!glass) return;
  Material material = *layer.material;
  field("Index");
  if (ImGui::DragFloat("##ior", &material.ior, 0.005f, 1.0f, max_ior, "%.3f",
                       ImGuiSliderFlags_AlwaysClamp))
    state.edit(SetMaterial{layer.id, material}, true);
  tip("Index of refraction: 1 for air, 1.333 for water, 1.5 for glass");
}

void gizmo_rows(GizmoState& gizmo) {
  static constexpr const char* tools[] = {"Off", "Move", "Turn", "Scale"};
  int tool = int(gizmo.tool);
  field("Gizmo");
  segments("gizmo", tools, tool);
  tip("G: handles on the selected layer. With Ctrl, they move in round steps, turn by 15\u00b0 and "
      "scale by tenths");
  gizmo.tool = GizmoTool(tool);
  if (gizmo.tool == GizmoTool::off || gizmo.tool == GizmoTool::scale) return;
  static constexpr const char* axes[] = {"World", "Layer"};
  int chosen = int(gizmo.axes);
  field("Axes");
  segments("axes", axes, chosen);
  tip("The axes along which the gizmo moves, and about which it turns");
  gizmo.axes = GizmoAxes(chosen);
}

void place_buttons(State& state, const DocumentLayer& layer) {
  if (button("Set on the ground", std::floor(0.42f * ImGui::GetContentRegionAvail().x)))
    state.edit(PlaceLayer{layer.id, on_the_ground(layer, state.controls.up())});
  tip("Moves the layer along the up axis until its lowest point is at height 0: the lowest "
      "corner of triangles, the lowest centre of splats");
  ImGui::SameLine();
  if (button("Center", share_of_row(2))) state.edit(PlaceLayer{layer.id, in_the_middle(layer)});
  tip("Moves the middle of the layer to the origin. F shows the whole scene");
  ImGui::SameLine();
  const Layer* const read = state.source.as_read(layer);
  const Disabled disabled(!read || read->world_from_layer == layer.world_from_layer);
  if (button("Reset", share_of_row(1))) state.edit(PlaceLayer{layer.id, read->world_from_layer});
  tip("Restores the position, rotation, scale and mirror in the file");
}

void order_buttons(State& state, std::size_t index) {
  const std::vector<DocumentLayer>& layers = state.source.document.layers;
  const LayerId id = layers[index].id;
  {
    const Disabled disabled(index == 0);
    if (button("Move up", share_of_row(3))) state.edit(ReorderLayer{id, index - 1});
    tip("At equal depth, the upper layer is visible");
  }
  ImGui::SameLine();
  {
    const Disabled disabled(index + 1 == layers.size());
    if (button("Move down", share_of_row(2))) state.edit(ReorderLayer{id, index + 1});
  }
  ImGui::SameLine();
  const Disabled disabled(layers.size() == 1);
  // It stays selected for the case that it comes back.
  if (button("Remove", share_of_row(1))) state.edit(RemoveLayers{{id}});
  tip("Frees the layer's memory on the device; the file stays");
}

}  // namespace

void layers_panel(State& state) {
  const std::vector<DocumentLayer>& layers = state.source.document.layers;
  const auto selected = std::size_t(&state.selected_layer() - layers.data());
  for (std::size_t i = 0; i < layers.size(); ++i) {
    ImGui::PushID(int(layers[i].id));
    if (layer_row(state, layers[i], i == selected)) state.layer_editing.selected = layers[i].id;
    ImGui::PopID();
  }
  const DocumentLayer& layer = layers[selected];
  // Otherwise a field that is being edited would pass its number on to the next selected layer.
  ImGui::PushID(int(layer.id));
  gizmo_rows(state.gizmo);
  name_row(state, layer);
  place_of(state, layer);
  ImGui::PopID();
  place_buttons(state, layer);
  if (layers.size() > 1) order_buttons(state, selected);
  ImGui::PushID(int(layer.id));
  surface_row(state, layer);
  ImGui::PopID();
}

}  // namespace tureen::viewer
