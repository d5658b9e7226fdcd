// A current OpenGL context without a window: EGL surfaceless or OSMesa. Both are loaded at run
// time, so the program also runs if one of them is not installed. Also wraps a context that another
// library made current.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace tureen::gl {

enum class Backend { automatic, egl, osmesa, external };
enum class Api { desktop, es };

struct ContextRequest {
  Backend backend = Backend::automatic;  // EGL first, then OSMesa
  Api api = Api::desktop;
  /// Requested version; drivers may return a higher compatible one. Default 0: the highest.
  int major = 0;
  int minor = 0;
};

/// Capabilities of a context that we use.
struct Capabilities {
  Api api = Api::desktop;
  int major = 0;
  int minor = 0;
  std::string renderer;  // GL_RENDERER
  std::string vendor;    // GL_VENDOR
  std::string version;   // GL_VERSION
  bool clip_control = false;
  bool multi_draw = false;
  bool timer_queries =
      false;              // timestamps are available but can be misleading (see gl::timers_mislead)
  bool software = false;  // draws_in_software: timer queries are misleading there
  int max_texture_size = 0;
  int max_image_side = 0;  // largest width and height of a frame
  int max_array_layers = 0;
  bool compute_shaders = false;  // with writable images: OpenGL 4.3, ES 3.1
  bool float_targets = false;    // draws into textures of 32-bit and 16-bit floats
  bool float_blending = false;   // also blends in those of 32 bits
  bool norm16_targets = false;   // draws into textures of 16-bit fractions
};

/// Whether this GL_RENDERER is a software renderer: llvmpipe, SwiftShader and similar.
bool draws_in_software(const std::string& renderer);

class Context {
 public:
  /// Creates a context and makes it current. Throws ContextError with the attempts and the packages
  /// to install. Not available in a browser, where a canvas provides one: use external().
  static Context create(const ContextRequest& request);

  using GetProcAddress = void* (*)(const char* name);
  /// Wraps a context that is current on this thread (a window's); never destroys it.
  static Context external(GetProcAddress get_proc_address, Api api);

  Context(Context&&) noexcept;
  Context& operator=(Context&&) noexcept;
  /// Destroys the context. If it was current, no context is current afterwards. If another context
  /// is current, that one stays current.
  ~Context();

  /// Makes this context current on the calling thread and loads its functions.
  void make_current();

  Backend backend() const;
  /// The library's function loader, for other users of this context.
  GetProcAddress get_proc_address() const { return platform_->get_proc_address(); }
  const Capabilities& capabilities() const { return capabilities_; }
  /// Such as "EGL, OpenGL 4.5 core".
  std::string description() const;

  /// A context from one library; implemented in context_egl.cpp and context_osmesa.cpp.
  class Platform {
   public:
    virtual ~Platform() = default;
    virtual void make_current() = 0;
    virtual GetProcAddress get_proc_address() const = 0;
    virtual Backend backend() const = 0;
  };

 private:
  Context(std::unique_ptr<Platform> platform, Api api);

  std::unique_ptr<Platform> platform_;
  Capabilities capabilities_;
};

/// Throws ContextError if the device has been reset since the current context was created (the
/// driver crashed or was replaced, or a draw took too long). After a reset, draw calls on this
/// context have no effect. Our contexts request reset notification; for an external one
/// (Backend::external) its creator decides. Does not wait.
void throw_if_lost();

}  // namespace tureen::gl
