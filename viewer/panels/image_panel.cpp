// Images to keep, and the command that makes the same without a window.
// clang-format off: the second header wants the first
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
    // What readers of images take (image/png.hpp).
    wish.size = glm::clamp(wish.size, 1, max_image_side);
    tip("Any size, beyond the window's and the device's: it is drawn in tiles");
  }
  ImGui::Checkbox("transparent background", &wish.transparent);
  ImGui::SetNextItemWidth(14 * ImGui::GetFontSize());
  ImGui::InputTextWithHint("folder", images_folder().string().c_str(), &state.settings.images);
  if (ImGui::Button("Save the image"))
    state.ask(TakeImage{wish.window_size ? glm::ivec2(0) : wish.size, wish.transparent});
  tip("Ctrl+S; a new name each time");
  ImGui::SameLine();
  if (ImGui::Button("Copy the command")) state.ask(CopyCommand{});
  tip("Ctrl+C: tureen render .. that draws this image without a window");
}

}  // namespace tureen::viewer
