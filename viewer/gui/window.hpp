// The window and its OpenGL contexts, by GLFW. The visible context draws. Hidden ones for
// background threads share its buffers and textures.
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
  /// Opens the window with a context of OpenGL 3.3 core, ES 3.0 or a compatible newer version, and
  /// makes it current. Throws ContextError with advice if there is no display. Only one window at a
  /// time, on the main thread.
  explicit Window(const WindowOptions& options);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  const gl::Context& context() const { return *context_; }

  /// Number of hidden contexts, one a thread.
  static constexpr int worker_contexts = 2;
  /// Makes one current on the calling thread. Vertex arrays and framebuffers are not shared.
  void make_worker_context_current(int which) const;
  void release_worker_context() const;

  /// The events since the last call. Waits up to `seconds` for one; wake() ends the wait.
  std::vector<Event> events(double seconds);
  /// Ends a wait in events(). May be called from any thread.
  static void wake();

  glm::ivec2 size() const;         // in points
  glm::ivec2 pixels() const;       // of the framebuffer
  double content_scale() const;    // scale of text, 1 on an ordinary screen
  void resize(glm::ivec2 points);  // a request to the system
  void set_title(const std::string& title);
  void set_vsync(bool on);
  /// Covers the monitor with the largest part of the window, or restores its old position.
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
