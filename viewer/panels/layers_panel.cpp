// The layers of the scene: visibility, order, removal, and the place of the selected one.
#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/decimal_text.hpp"
#include "viewer/panels.hpp"
#include "viewer/panels/widgets.hpp"

namespace tureen::viewer {

namespace {

/// Smallest and largest scale.
constexpr double min_scale = 1e-6, max_scale = 1e6;

/// Returns whether the layer changed.
bool layer_row(StageLayer& layer, bool selected, bool& clicked) {
  const bool changed = check("##visible", &layer.visible);
  tip("Show");
  ImGui::SameLine();
  const std::string count = counted(layer.primitive_count());
  const float count_left = ImGui::GetContentRegionMax().x - ImGui::CalcTextSize(count.c_str()).x;
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  clicked =
      ImGui::Selectable("##layer", selected, 0, {count_left - gap - ImGui::GetCursorPosX(), 0});
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
  tip(layer.soup() ? "triangles" : "splats");
  return changed;
}

/// Lengths to a hundred-thousandth of the scene's size: the noise of rounding disappears.
std::string length_format(double radius) {
  return fmt::format("%.{}f", std::clamp(5 - int(std::floor(std::log10(radius))), 0, 12));
}

/// A row of numbers to drag, or to type after a double click. Returns whether they changed.
bool numbers_row(const char* name, std::span<double> values, double speed, const char* format) {
  field(name);
  return ImGui::DragScalarN(fmt::format("##{}", name).c_str(), ImGuiDataType_Double, values.data(),
                            int(values.size()), float(speed), nullptr, nullptr, format);
}

/// Returns whether the numbers changed.
bool place_rows(Similarity& numbers, double radius) {
  bool changed = numbers_row("Position", std::span(&numbers.position.x, 3), radius / 500,
                             length_format(radius).c_str());
  tip("Of the layer's origin, in world units: x, y, z. Drag, or double-click to type");
  changed |= numbers_row("Rotation", std::span(&numbers.angles.x, 3), 0.5, "%.5g");
  tip("In degrees, about the world's axes through the layer's origin: first about x, then y, then "
      "z; "
      "counter-clockwise, seen from the positive end of the axis");
  field("Scale");
  ImGui::SetNextItemWidth(5.5f * ImGui::GetFontSize());
  changed |=
      ImGui::DragScalar("##scale", ImGuiDataType_Double, &numbers.scale, float(numbers.scale / 200),
                        &min_scale, &max_scale, "%.6g", ImGuiSliderFlags_AlwaysClamp);
  ImGui::SameLine();
  changed |= check_beside_field("Mirror", &numbers.mirror);
  tip("Negates x of the layer, before the rotation");
  return changed;
}

/// Returns whether the layers changed.
bool order_buttons(std::vector<StageLayer>& layers, std::size_t& selected) {
  bool changed = false;
  const auto move_to = [&](std::size_t place) {
    std::swap(layers[selected], layers[place]);
    selected = place;
    changed = true;
  };
  {
    const Disabled disabled(selected == 0);
    if (button("Move up", share_of_row(3))) move_to(selected - 1);
    tip("At equal depth, the upper layer is visible");
  }
  ImGui::SameLine();
  {
    const Disabled disabled(selected + 1 == layers.size());
    if (button("Move down", share_of_row(2)) && !changed) move_to(selected + 1);
  }
  ImGui::SameLine();
  const Disabled disabled(layers.size() == 1);
  if (button("Remove", share_of_row(1)) && !changed) {
    layers.erase(layers.begin() + std::ptrdiff_t(selected));
    selected = std::min(selected, layers.size() - 1);
    changed = true;
  }
  tip("Frees the layer's memory; the file stays");
  return changed;
}

}  // namespace

void layers_panel(State& state) {
  const Stage& stage = *state.stage;
  std::vector<StageLayer> layers = stage.layers;
  LayerEditing& editing = state.layer_editing;
  editing.selected = std::min(editing.selected, layers.size() - 1);
  bool changed = false;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    ImGui::PushID(int(i));
    bool clicked = false;
    changed |= layer_row(layers[i], i == editing.selected, clicked);
    if (clicked) editing.selected = i;
    ImGui::PopID();
  }
  StageLayer& layer = layers[editing.selected];
  if (editing.matrix != layer.world_from_layer) {
    editing.matrix = layer.world_from_layer;
    editing.numbers = similarity_of(editing.matrix);
  }
  // Otherwise a field that is being edited would pass its number on to the next selected layer.
  ImGui::PushID(layer.primitives.get());
  if (place_rows(editing.numbers, state.controls.radius())) {
    const glm::dmat4 matrix = matrix_of(editing.numbers);
    // A typed number may be too large for a double.
    if (defect(Layer{.world_from_layer = matrix})) {
      editing.numbers = similarity_of(editing.matrix);
    } else {
      editing.matrix = layer.world_from_layer = matrix;
      changed = true;
    }
  }
  ImGui::PopID();
  if (button("Reset the place")) {
    layer.world_from_layer = stage.as_read(layer).world_from_layer;
    changed = true;
  }
  tip("The position, rotation, scale and mirror that the file gives");
  changed |= order_buttons(layers, editing.selected);
  if (changed) state.ask(ArrangeLayers{stage.scene, std::move(layers)});
}

}  // namespace tureen::viewer
