// Dear ImGui behind our own events and our own drawing: fed from events, so that a replayed session
// is a person's, and drawn by the runtime's GL, so that it works on OpenGL ES and under any loader.
#pragma once

#include <glm/vec2.hpp>
#include <memory>
#include <optional>

#include "viewer/input/event.hpp"
#include "viewer/window.hpp"

struct ImGuiContext;
struct ImDrawData;

namespace tureen::viewer {

class GuiDrawing;

struct GuiOptions {
  /// Larger text for screens with many pixels to the inch.
  double scale = 1;
  /// A font of the machine's where there is one; without it that of Dear ImGui, which looks the
  /// same everywhere: for goldens.
  bool machine_font = true;
};

class Gui {
 public:
  /// The context of `window` must be current, now and in draw(). `window` must outlive it.
  Gui(Window& window, const GuiOptions& options);
  ~Gui();
  Gui(const Gui&) = delete;
  Gui& operator=(const Gui&) = delete;

  void feed(const Event& event);
  /// Whether the pointer or the keyboard is the interface's: such events are not the scene's.
  bool takes_pointer() const;
  bool takes_keys() const;

  struct Frame {
    glm::ivec2 points, pixels;  // of the window
    double seconds;             // since the last frame
  };
  void begin(const Frame& frame);
  /// Ends what begin() began and draws it over what the window's framebuffer holds.
  void draw();

  /// The shape that the pointer should have.
  Window::Pointer pointer() const;

 private:
  struct Destroy {
    void operator()(ImGuiContext* context) const;
  };
  std::unique_ptr<ImGuiContext, Destroy> context_;
  std::unique_ptr<GuiDrawing> drawing_;
};

}  // namespace tureen::viewer
