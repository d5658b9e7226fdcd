// Saves images, and copies the command that draws the same image without a window.
// clang-format off: the second header needs the first
#include <imgui/imgui.h>
#include <imgui/imgui_stdlib.h>
// clang-format on

#include <glm/common.hpp>

#include "image/png.hpp"
#include "viewer/panels.hpp"
#include "viewer/panels/widgets.hpp"

namespace tureen::viewer {

void image_panel(State& state) {
  ImageWish& wish = state.image;
  ImGui::Checkbox("as large as the window", &wish.window_size);
  if (!wish.window_size) {
    ImGui::SetNextItemWidth(10 * ImGui::GetFontSize());
    ImGui::InputInt2("pixels", &wish.size.x);
    // The limit of image readers (image/png.hpp).
    wish.size = glm::clamp(wish.size, 1, max_image_side);
    tip("Any size: larger images than the device's limit are drawn in tiles");
  }
  ImGui::Checkbox("transparent background", &wish.transparent);
  ImGui::SetNextItemWidth(14 * ImGui::GetFontSize());
  ImGui::InputTextWithHint("folder", images_folder().string().c_str(), &state.settings.images);
  if (ImGui::Button("Save the image"))
    state.ask(TakeImage{wish.window_size ? glm::ivec2(0) : wish.size, wish.transparent});
  tip("Ctrl+S; each image gets a new name");
  ImGui::SameLine();
  if (ImGui::Button("Copy the command")) state.ask(CopyCommand{});
  tip("Ctrl+C: the tureen render command that draws this image without a window");
}

}  // namespace tureen::viewer
