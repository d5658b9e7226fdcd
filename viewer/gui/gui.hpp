// Dear ImGui with our own events and drawing. It is fed from events, so that a replayed session
// behaves like the recorded one. The runtime's GL draws it, so that it works on OpenGL ES and with
// any loader.
#pragma once

#include <glm/vec2.hpp>
#include <memory>

#include "viewer/gui/font.hpp"
#include "viewer/gui/window.hpp"
#include "viewer/input/event.hpp"

struct ImGuiContext;
struct ImDrawData;

namespace tureen::viewer {

class GuiDrawing;

struct GuiOptions {
  /// Scale of texts and spacing, 1..4, for high-DPI screens.
  double scale = 1;
  /// Framebuffer pixels in a point, 1..4. Fonts have this resolution.
  double density = 1;
  FontChoice font = FontChoice::machine;
};

class Gui {
 public:
  /// The context of `window` must be current, now and in draw(). `window` must outlive it.
  Gui(Window& window, const GuiOptions& options);
  ~Gui();
  Gui(const Gui&) = delete;
  Gui& operator=(const Gui&) = delete;

  void feed(const Event& event);
  /// Whether the interface uses the pointer or the keyboard; the scene then ignores their events.
  bool takes_pointer() const;
  bool takes_keys() const;

  struct Frame {
    glm::ivec2 points, pixels;  // of the window
    double seconds;             // since the last frame
  };
  void begin(const Frame& frame);
  /// Ends the frame of begin() and draws it over the window's framebuffer.
  void draw();

  /// The requested shape of the pointer.
  Window::Pointer pointer() const;

 private:
  struct Destroy {
    void operator()(ImGuiContext* context) const;
  };
  std::unique_ptr<ImGuiContext, Destroy> context_;
  std::unique_ptr<GuiDrawing> drawing_;
};

}  // namespace tureen::viewer
