#include "viewer/gui.hpp"

#include <imgui/imgui.h>

#include <algorithm>
#include <filesystem>
#include <glm/common.hpp>
#include <string>
#include <type_traits>

#include "viewer/gui_drawing.hpp"

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

/// Common sans-serif fonts of desktops, the likelier first.
std::optional<std::string> machine_font() {
  for (const char* path :
       {"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
        "/usr/share/fonts/truetype/noto/NotoSans-Regular.ttf",
        "/usr/share/fonts/truetype/liberation/LiberationSans-Regular.ttf",
        "/usr/share/fonts/TTF/DejaVuSans.ttf", "/System/Library/Fonts/Supplemental/Arial.ttf",
        "C:/Windows/Fonts/segoeui.ttf"})
    if (std::error_code ignored; std::filesystem::exists(path, ignored)) return path;
  return std::nullopt;
}

void load_font(ImGuiIO& io, const GuiOptions& options) {
  const auto scale = static_cast<float>(std::clamp(options.scale, 1.0, 4.0));
  // 15 points of a proportional font are as readable as 13 points of the built-in font.
  const auto path = options.machine_font ? machine_font() : std::nullopt;
  if (path && io.Fonts->AddFontFromFileTTF(path->c_str(), 15.0f * scale)) return;
  ImFontConfig config;
  config.SizePixels = 13.0f * scale;
  io.Fonts->AddFontDefault(&config);
}

/// Grey styles, so that only the image has colour.
void dress(double scale) {
  ImGui::StyleColorsDark();
  ImGuiStyle& style = ImGui::GetStyle();
  style.WindowRounding = 4;
  style.FrameRounding = 3;
  style.GrabRounding = 3;
  style.WindowBorderSize = 0;
  style.FramePadding = {6, 3};
  style.ItemSpacing = {7, 5};
  style.Colors[ImGuiCol_WindowBg] = {0.09f, 0.09f, 0.10f, 0.92f};
  style.Colors[ImGuiCol_PopupBg] = {0.11f, 0.11f, 0.12f, 0.97f};
  style.Colors[ImGuiCol_FrameBg] = {0.20f, 0.20f, 0.22f, 1.0f};
  style.Colors[ImGuiCol_TitleBgActive] = {0.15f, 0.15f, 0.17f, 1.0f};
  style.Colors[ImGuiCol_Header] = {0.20f, 0.21f, 0.23f, 1.0f};
  style.ScaleAllSizes(static_cast<float>(std::clamp(scale, 1.0, 4.0)));
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
  dress(options.scale);
  load_font(io, options);
  drawing_ = std::make_unique<GuiDrawing>(window.context().capabilities().api);
}

Gui::~Gui() = default;

void Gui::feed(const Event& event) { std::visit(Feeder{ImGui::GetIO()}, event); }

bool Gui::takes_pointer() const { return ImGui::GetIO().WantCaptureMouse; }
bool Gui::takes_keys() const { return ImGui::GetIO().WantTextInput; }

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
  ImGui::Render();
  drawing_->draw(*ImGui::GetDrawData());
}

Window::Pointer Gui::pointer() const {
  switch (ImGui::GetMouseCursor()) {
    case ImGuiMouseCursor_TextInput:
      return Window::Pointer::text;
    case ImGuiMouseCursor_Hand:
      return Window::Pointer::hand;
    case ImGuiMouseCursor_ResizeEW:
      return Window::Pointer::resize_horizontally;
    case ImGuiMouseCursor_ResizeNS:
      return Window::Pointer::resize_vertically;
    case ImGuiMouseCursor_ResizeAll:
      return Window::Pointer::move;
    default:
      return Window::Pointer::arrow;
  }
}

}  // namespace tureen::viewer
