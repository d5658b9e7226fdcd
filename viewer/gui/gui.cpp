#include "viewer/gui/gui.hpp"

#include <imgui/imgui.h>

#include <algorithm>
#include <glm/common.hpp>
#include <string>
#include <type_traits>
#include <utility>

#include "viewer/gui/font.hpp"
#include "viewer/gui/gui_drawing.hpp"
#include "viewer/gui/item_places.hpp"
#include "viewer/gui/theme.hpp"

namespace tureen::viewer {

namespace {

// Static, because Dear ImGui needs a pointer that stays valid until the next call.
const char* read_clipboard(void* window) {
  static std::string text;
  text = static_cast<const Window*>(window)->clipboard();
  return text.c_str();
}

void write_clipboard(void* window, const char* text) {
  static_cast<Window*>(window)->set_clipboard(text);
}

void map_keys(ImGuiIO& io) {
  const auto map = [&io](ImGuiKey_ gui, Key ours) { io.KeyMap[gui] = static_cast<int>(ours); };
  map(ImGuiKey_Tab, Key::tab);
  map(ImGuiKey_LeftArrow, Key::left);
  map(ImGuiKey_RightArrow, Key::right);
  map(ImGuiKey_UpArrow, Key::up);
  map(ImGuiKey_DownArrow, Key::down);
  map(ImGuiKey_PageUp, Key::page_up);
  map(ImGuiKey_PageDown, Key::page_down);
  map(ImGuiKey_Home, Key::home);
  map(ImGuiKey_End, Key::end);
  map(ImGuiKey_Insert, Key::insert);
  map(ImGuiKey_Delete, Key::del);
  map(ImGuiKey_Backspace, Key::backspace);
  map(ImGuiKey_Space, Key::space);
  map(ImGuiKey_Enter, Key::enter);
  map(ImGuiKey_Escape, Key::escape);
  map(ImGuiKey_A, Key::a);
  map(ImGuiKey_C, Key::c);
  map(ImGuiKey_V, Key::v);
  map(ImGuiKey_X, Key::x);
  map(ImGuiKey_Y, Key::y);
  map(ImGuiKey_Z, Key::z);
}

/// Passes each kind of event to Dear ImGui.
struct Feeder {
  ImGuiIO& io;

  void operator()(const PointerMoved& event) const {
    io.MousePos = {static_cast<float>(event.x), static_cast<float>(event.y)};
  }
  void operator()(const ButtonChanged& event) const {
    io.MouseDown[static_cast<int>(event.button)] = event.down;
  }
  void operator()(const Scrolled& event) const {
    io.MouseWheelH += static_cast<float>(event.right);
    io.MouseWheel += static_cast<float>(event.away);
  }
  void operator()(const KeyChanged& event) const {
    io.KeysDown[static_cast<int>(event.key)] = event.down;
    io.KeyCtrl = io.KeysDown[static_cast<int>(Key::control)];
    io.KeyShift = io.KeysDown[static_cast<int>(Key::shift)];
    io.KeyAlt = io.KeysDown[static_cast<int>(Key::alt)];
    io.KeySuper = io.KeysDown[static_cast<int>(Key::super)];
  }
  void operator()(const TextTyped& event) const { io.AddInputCharacter(event.code_point); }
  void operator()(const FocusChanged& event) const {
    io.AddFocusEvent(event.focused);
    if (event.focused) return;
    // Keys released in another window are never reported.
    std::fill(std::begin(io.KeysDown), std::end(io.KeysDown), false);
    io.KeyCtrl = io.KeyShift = io.KeyAlt = io.KeySuper = false;
  }
  template <class Other>
  void operator()(const Other&) const {}
};

}  // namespace

void Gui::Destroy::operator()(ImGuiContext* context) const { ImGui::DestroyContext(context); }

Gui::Gui(Window& window, const GuiOptions& options) : context_(ImGui::CreateContext()) {
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;  // viewer/files/settings.hpp stores the settings
  io.LogFilename = nullptr;
  io.BackendFlags |= ImGuiBackendFlags_HasMouseCursors;
  io.GetClipboardTextFn = read_clipboard;
  io.SetClipboardTextFn = write_clipboard;
  io.ClipboardUserData = &window;
  map_keys(io);
  const double scale = std::clamp(options.scale, 1.0, 4.0);
  const double density = std::clamp(options.density, 1.0, 4.0);
  set_shapes(scale);
  set_colors(Theme::dark);  // until the first frame
  add_fonts(*io.Fonts, options.font, {.scale = scale * density});
  io.FontGlobalScale = static_cast<float>(1 / density);
  drawing_ = std::make_unique<GuiDrawing>(window.context().capabilities().api);
}

Gui::~Gui() = default;

void Gui::feed(const Event& event) { std::visit(Feeder{ImGui::GetIO()}, event); }

bool Gui::takes_pointer() const { return ImGui::GetIO().WantCaptureMouse; }
// WantTextInput stays set for one frame after a field closes; a shortcut in that frame would be
// lost.
bool Gui::takes_keys() const { return ImGui::GetIO().WantTextInput && ImGui::IsAnyItemActive(); }

void Gui::begin(const Frame& frame) {
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = {static_cast<float>(frame.points.x), static_cast<float>(frame.points.y)};
  const glm::vec2 scale = glm::vec2(frame.pixels) / glm::vec2(glm::max(frame.points, 1));
  io.DisplayFramebufferScale = {scale.x, scale.y};
  // Dear ImGui asserts that time passes.
  io.DeltaTime = static_cast<float>(std::max(frame.seconds, 1e-6));
  ImGui::NewFrame();
}

void Gui::draw() {
  end_item_notes();
  ImGui::Render();
  drawing_->draw(*ImGui::GetDrawData());
}

Window::Pointer Gui::pointer() const {
  using Pointer = Window::Pointer;
  static constexpr std::pair<ImGuiMouseCursor, Pointer> shapes[] = {
      {ImGuiMouseCursor_TextInput, Pointer::text},
      {ImGuiMouseCursor_Hand, Pointer::hand},
      {ImGuiMouseCursor_ResizeEW, Pointer::resize_horizontally},
      {ImGuiMouseCursor_ResizeNS, Pointer::resize_vertically},
      {ImGuiMouseCursor_ResizeAll, Pointer::move}};
  for (const auto& [wanted, shape] : shapes)
    if (ImGui::GetMouseCursor() == wanted) return shape;
  return Pointer::arrow;
}

}  // namespace tureen::viewer
