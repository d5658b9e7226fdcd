// The window and its OpenGL contexts: the visible one draws, hidden ones that share its buffers and
// textures serve threads in the background. GLFW, behind one file.
#pragma once

#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/gl/context.hpp"
#include "viewer/input/event.hpp"

namespace tureen::viewer {

struct WindowOptions {
  gl::Api api = gl::Api::desktop;
  glm::ivec2 size{1280, 800};  // in points
};

class Window {
 public:
  /// Opens the window with a context of OpenGL 3.3 core or ES 3.0 (or what compatible newer one the
  /// driver gives) and makes it current. Throws ContextError with advice where there is no display.
  /// One at a time, on the main thread.
  explicit Window(const WindowOptions& options);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  const gl::Context& context() const { return *context_; }

  /// Hidden contexts, one a thread.
  static constexpr int worker_contexts = 2;
  /// Makes one current on the calling thread. Vertex arrays and framebuffers are not shared.
  void make_worker_context_current(int which) const;
  void release_worker_context() const;

  /// What happened since the last time; waits for something for up to `seconds`, which wake() cuts
  /// short.
  std::vector<Event> events(double seconds);
  /// From any thread.
  static void wake();

  glm::ivec2 size() const;         // in points
  glm::ivec2 pixels() const;       // of the framebuffer
  double content_scale() const;    // how much larger text must be than on an ordinary screen
  void resize(glm::ivec2 points);  // asks for it
  void set_title(const std::string& title);
  void set_vsync(bool on);
  /// Covers the monitor that holds most of the window, or goes back to where it was.
  void set_fullscreen(bool on);
  bool fullscreen() const { return restored_.has_value(); }
  void present();

  std::string clipboard() const;
  void set_clipboard(const std::string& text);

  enum class Pointer { arrow, text, hand, resize_horizontally, resize_vertically, move };
  void set_pointer(Pointer pointer);

 private:
  struct Handles;
  struct Placement {
    glm::ivec2 position, size;
  };
  std::unique_ptr<Handles> handles_;
  std::unique_ptr<gl::Context> context_;
  std::vector<Event> events_;
  std::optional<Placement> restored_;
};

}  // namespace tureen::viewer
