#include "viewer/gui/window.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <array>
#include <utility>

#include "base/error.hpp"

namespace tureen::viewer {

namespace {

std::string last_reason() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text ? text : "no reason reported";
}

[[noreturn]] void fail(const std::string& what) {
  throw ContextError(what + " (" + last_reason() +
                         "): tureen-view needs a display and OpenGL 3.3 or OpenGL ES 3.0",
                     "without a display, tureen render draws images: tureen render SCENE -o "
                     "image.png");
}

/// Initialises GLFW for the lifetime of the window.
class Library {
 public:
  Library() {
    if (!glfwInit()) fail("no window can be opened");
  }
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;
  ~Library() {
    // This unloads the driver. Under the address sanitizer it stays loaded: leaks of an unloaded
    // driver have no symbols and look like ours.
#ifndef __SANITIZE_ADDRESS__
    glfwTerminate();
#endif
  }
};

using Handle = std::unique_ptr<GLFWwindow, decltype(&glfwDestroyWindow)>;

std::optional<Key> key_of(int code) {
  if (code >= GLFW_KEY_A && code <= GLFW_KEY_Z) return Key(int(Key::a) + code - GLFW_KEY_A);
  if (code >= GLFW_KEY_0 && code <= GLFW_KEY_9) return Key(int(Key::digit_0) + code - GLFW_KEY_0);
  if (code >= GLFW_KEY_KP_0 && code <= GLFW_KEY_KP_9)
    return Key(int(Key::digit_0) + code - GLFW_KEY_KP_0);
  if (code >= GLFW_KEY_F1 && code <= GLFW_KEY_F12) return Key(int(Key::f1) + code - GLFW_KEY_F1);
  static constexpr std::pair<int, Key> others[] = {
      {GLFW_KEY_LEFT, Key::left},
      {GLFW_KEY_RIGHT, Key::right},
      {GLFW_KEY_UP, Key::up},
      {GLFW_KEY_DOWN, Key::down},
      {GLFW_KEY_HOME, Key::home},
      {GLFW_KEY_END, Key::end},
      {GLFW_KEY_PAGE_UP, Key::page_up},
      {GLFW_KEY_PAGE_DOWN, Key::page_down},
      {GLFW_KEY_INSERT, Key::insert},
      {GLFW_KEY_DELETE, Key::del},
      {GLFW_KEY_LEFT_BRACKET, Key::left_bracket},
      {GLFW_KEY_RIGHT_BRACKET, Key::right_bracket},
      {GLFW_KEY_MINUS, Key::minus},
      {GLFW_KEY_KP_SUBTRACT, Key::minus},
      {GLFW_KEY_EQUAL, Key::equal},
      {GLFW_KEY_KP_ADD, Key::equal},
      {GLFW_KEY_COMMA, Key::comma},
      {GLFW_KEY_PERIOD, Key::period},
      {GLFW_KEY_SLASH, Key::slash},
      {GLFW_KEY_TAB, Key::tab},
      {GLFW_KEY_BACKSPACE, Key::backspace},
      {GLFW_KEY_ENTER, Key::enter},
      {GLFW_KEY_KP_ENTER, Key::enter},
      {GLFW_KEY_ESCAPE, Key::escape},
      {GLFW_KEY_SPACE, Key::space},
      {GLFW_KEY_LEFT_SHIFT, Key::shift},
      {GLFW_KEY_RIGHT_SHIFT, Key::shift},
      {GLFW_KEY_LEFT_CONTROL, Key::control},
      {GLFW_KEY_RIGHT_CONTROL, Key::control},
      {GLFW_KEY_LEFT_ALT, Key::alt},
      {GLFW_KEY_RIGHT_ALT, Key::alt},
      {GLFW_KEY_LEFT_SUPER, Key::super},
      {GLFW_KEY_RIGHT_SUPER, Key::super},
  };
  for (const auto& [known, key] : others)
    if (known == code) return key;
  return std::nullopt;
}

void* find_function(const char* name) { return reinterpret_cast<void*>(glfwGetProcAddress(name)); }

void want_context(gl::Api api) {
  const bool desktop = api == gl::Api::desktop;
  glfwDefaultWindowHints();
  glfwWindowHint(GLFW_CLIENT_API, desktop ? GLFW_OPENGL_API : GLFW_OPENGL_ES_API);
  glfwWindowHint(GLFW_CONTEXT_CREATION_API,
                 desktop ? GLFW_NATIVE_CONTEXT_API : GLFW_EGL_CONTEXT_API);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, desktop ? 3 : 0);
  if (desktop) {
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);  // macOS supports only these
    // Requests reset notification for throw_if_lost(). For OpenGL ES, Mesa rejects GLFW's request.
    glfwWindowHint(GLFW_CONTEXT_ROBUSTNESS, GLFW_LOSE_CONTEXT_ON_RESET);
  }
  // The runtime draws to its own targets, so the window needs only colour.
  glfwWindowHint(GLFW_DEPTH_BITS, 0);
  glfwWindowHint(GLFW_STENCIL_BITS, 0);
}

std::vector<Event>& queue_of(GLFWwindow* window) {
  return *static_cast<std::vector<Event>*>(glfwGetWindowUserPointer(window));
}

/// The monitor with the largest share of the window.
GLFWmonitor* monitor_under(GLFWwindow* window) {
  int x = 0, y = 0, width = 0, height = 0;
  glfwGetWindowPos(window, &x, &y);
  glfwGetWindowSize(window, &width, &height);
  int count = 0;
  GLFWmonitor** monitors = glfwGetMonitors(&count);
  GLFWmonitor* best = glfwGetPrimaryMonitor();
  int best_area = 0;
  for (int i = 0; i < count; ++i) {
    int left = 0, top = 0;
    glfwGetMonitorPos(monitors[i], &left, &top);
    const GLFWvidmode* mode = glfwGetVideoMode(monitors[i]);
    if (!mode) continue;
    const int across = std::min(x + width, left + mode->width) - std::max(x, left);
    const int down = std::min(y + height, top + mode->height) - std::max(y, top);
    if (across > 0 && down > 0 && across * down > best_area) {
      best_area = across * down;
      best = monitors[i];
    }
  }
  return best;
}

void listen(GLFWwindow* window) {
  glfwSetCursorPosCallback(window, [](GLFWwindow* w, double x, double y) {
    queue_of(w).push_back(PointerMoved{x, y});
  });
  glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int button, int action, int) {
    if (button <= GLFW_MOUSE_BUTTON_MIDDLE)
      queue_of(w).push_back(ButtonChanged{Button(button), action == GLFW_PRESS});
  });
  glfwSetScrollCallback(window, [](GLFWwindow* w, double right, double away) {
    queue_of(w).push_back(Scrolled{right, away});
  });
  glfwSetKeyCallback(window, [](GLFWwindow* w, int code, int, int action, int) {
    if (const std::optional<Key> key = key_of(code); key && action != GLFW_REPEAT)
      queue_of(w).push_back(KeyChanged{*key, action == GLFW_PRESS});
  });
  glfwSetCharCallback(window, [](GLFWwindow* w, unsigned code_point) {
    queue_of(w).push_back(TextTyped{code_point});
  });
  glfwSetDropCallback(window, [](GLFWwindow* w, int count, const char** paths) {
    queue_of(w).push_back(FilesDropped{{paths, paths + count}});
  });
  glfwSetWindowSizeCallback(window, [](GLFWwindow* w, int width, int height) {
    queue_of(w).push_back(Resized{width, height});
  });
  glfwSetWindowFocusCallback(window, [](GLFWwindow* w, int focused) {
    queue_of(w).push_back(FocusChanged{focused == GLFW_TRUE});
  });
  glfwSetWindowCloseCallback(window, [](GLFWwindow* w) { queue_of(w).push_back(CloseAsked{}); });
}

constexpr int pointer_count = 6;

}  // namespace

struct Window::Handles {
  Library library;
  Handle window{nullptr, &glfwDestroyWindow};
  std::vector<Handle> workers;
  std::array<GLFWcursor*, pointer_count> pointers{};  // destroyed with the library
};

Window::Window(const WindowOptions& options) : handles_(std::make_unique<Handles>()) {
  want_context(options.api);
  handles_->window.reset(
      glfwCreateWindow(options.size.x, options.size.y, "Tureen", nullptr, nullptr));
  if (!handles_->window) fail("no window with OpenGL can be opened");
  GLFWwindow* window = handles_->window.get();

  glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
  for (int i = 0; i < worker_contexts; ++i) {
    handles_->workers.emplace_back(glfwCreateWindow(16, 16, "Tureen (background)", nullptr, window),
                                   &glfwDestroyWindow);
    if (!handles_->workers.back()) fail("no second OpenGL context can be created");
  }

  glfwMakeContextCurrent(window);
  context_ = std::make_unique<gl::Context>(gl::Context::external(&find_function, options.api));
  glfwSetWindowUserPointer(window, &events_);
  listen(window);
  static constexpr int shapes[pointer_count] = {GLFW_ARROW_CURSOR,   GLFW_IBEAM_CURSOR,
                                                GLFW_HAND_CURSOR,    GLFW_HRESIZE_CURSOR,
                                                GLFW_VRESIZE_CURSOR, GLFW_CROSSHAIR_CURSOR};
  for (int i = 0; i < pointer_count; ++i)
    handles_->pointers[std::size_t(i)] = glfwCreateStandardCursor(shapes[i]);
}

Window::~Window() = default;

void Window::make_worker_context_current(int which) const {
  glfwMakeContextCurrent(handles_->workers.at(static_cast<std::size_t>(which)).get());
}
void Window::release_worker_context() const { glfwMakeContextCurrent(nullptr); }

std::vector<Event> Window::events(double seconds) {
  if (seconds > 0)
    glfwWaitEventsTimeout(seconds);
  else
    glfwPollEvents();
  return std::exchange(events_, {});
}

void Window::wake() { glfwPostEmptyEvent(); }

glm::ivec2 Window::size() const {
  glm::ivec2 size(0);
  glfwGetWindowSize(handles_->window.get(), &size.x, &size.y);
  return size;
}

glm::ivec2 Window::pixels() const {
  glm::ivec2 size(0);
  glfwGetFramebufferSize(handles_->window.get(), &size.x, &size.y);
  return size;
}

double Window::content_scale() const {
  float across = 1, down = 1;
  glfwGetWindowContentScale(handles_->window.get(), &across, &down);
  return std::max(across, down);
}

void Window::resize(glm::ivec2 points) {
  glfwSetWindowSize(handles_->window.get(), points.x, points.y);
}

void Window::set_title(const std::string& title) {
  glfwSetWindowTitle(handles_->window.get(), title.c_str());
}

void Window::set_vsync(bool on) { glfwSwapInterval(on ? 1 : 0); }

void Window::set_fullscreen(bool on) {
  GLFWwindow* window = handles_->window.get();
  if (on == fullscreen()) return;
  if (!on) {
    glfwSetWindowMonitor(window, nullptr, restored_->position.x, restored_->position.y,
                         restored_->size.x, restored_->size.y, GLFW_DONT_CARE);
    restored_.reset();
    return;
  }
  GLFWmonitor* monitor = monitor_under(window);
  const GLFWvidmode* mode = monitor ? glfwGetVideoMode(monitor) : nullptr;
  if (!mode) return;
  Placement placement{{0, 0}, size()};
  glfwGetWindowPos(window, &placement.position.x, &placement.position.y);
  restored_ = placement;
  glfwSetWindowMonitor(window, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
}

void Window::present() {
  gl::throw_if_lost();
  glfwSwapBuffers(handles_->window.get());
}

std::string Window::clipboard() const {
  const char* text = glfwGetClipboardString(handles_->window.get());
  return text ? text : "";
}

void Window::set_clipboard(const std::string& text) {
  glfwSetClipboardString(handles_->window.get(), text.c_str());
}

void Window::set_pointer(Pointer pointer) {
  glfwSetCursor(handles_->window.get(), handles_->pointers[std::size_t(pointer)]);
}

}  // namespace tureen::viewer
