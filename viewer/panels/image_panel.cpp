// Saves images, and copies the command that draws the same image without a window.
// clang-format off: the second header needs the first
#include <imgui/imgui.h>
#include <imgui/imgui_stdlib.h>
// clang-format on

#include <glm/common.hpp>
#include <string>

#include "image/png.hpp"
#include "viewer/panels.hpp"
#include "viewer/panels/widgets.hpp"

namespace tureen::viewer {

namespace {

/// As on the page: the size of the window's image, common sizes, or numbers.
void size_rows(ImageWish& wish) {
  static constexpr struct {
    const char* text;
    glm::ivec2 size;
  } sizes[] = {{"1280 \u00d7 720", {1280, 720}},
               {"1920 \u00d7 1080", {1920, 1080}},
               {"3840 \u00d7 2160", {3840, 2160}},
               {"1024 \u00d7 1024", {1024, 1024}},
               {"2048 \u00d7 2048", {2048, 2048}}};
  constexpr const char *as_shown = "as shown", *other = "other";
  const char* current = wish.window_size ? as_shown : other;
  if (!wish.window_size && !wish.other_size)
    for (const auto& each : sizes)
      if (each.size == wish.size) current = each.text;
  field("Size");
  if (ImGui::BeginCombo("##size", current, ImGuiComboFlags_HeightLarge)) {
    if (list_item(as_shown, wish.window_size)) wish.window_size = true;
    for (const auto& each : sizes)
      if (list_item(each.text, current == each.text)) {
        wish.window_size = wish.other_size = false;
        wish.size = each.size;
      }
    if (list_item(other, current == other)) {
      wish.window_size = false;
      wish.other_size = true;
    }
    ImGui::EndCombo();
  }
  tip("Images beyond the device's limit are drawn in tiles");
  if (current != other) return;
  field("Pixels");
  ImGui::InputInt2("##pixels", &wish.size.x);
  // The limit of image readers (image/png.hpp).
  wish.size = glm::clamp(wish.size, 1, max_image_side);
}

}  // namespace

void image_panel(State& state) {
  ImageWish& wish = state.image;
  size_rows(wish);
  field("Folder");
  if (state.images_option.empty()) {
    ImGui::InputTextWithHint("##folder", images_folder().string().c_str(), &state.settings.images);
  } else {
    const Disabled disabled(true);
    std::string folder = state.images_option.string();
    ImGui::InputText("##folder", &folder);
  }
  tip(state.folder_of_images().string());
  check("Transparent background", &wish.transparent);
  if (button("Save the image"))
    state.ask(TakeImage{wish.window_size ? glm::ivec2(0) : wish.size, wish.transparent});
  tip("P; each image gets a new name");
  beside("Copy the command");
  if (button("Copy the command")) state.ask(CopyCommand{});
  tip("Ctrl+C: the tureen render command that draws this image without a window");
  beside("Save as a web page");
  if (button("Save as a web page")) state.ask(SavePage{});
  tip("One file with the scene and its viewer; opens with a double click");
}

}  // namespace tureen::viewer
