// A current OpenGL context without a window: EGL surfaceless or OSMesa, both loaded at run time so
// that one program runs where either is missing; or a context that somebody else made current.
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
  /// The version asked for; drivers may give a higher compatible one. 0 asks for the highest.
  int major = 0;
  int minor = 0;
};

/// What a context can do, as far as we care.
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
      false;              // timestamps can be had; whether they mean anything is another matter
  bool software = false;  // draws_in_software: timer queries mislead there
  int max_texture_size = 0;
  int max_picture_side = 0;  // the widest and highest frame that can be drawn
  int max_array_layers = 0;
  bool compute_shaders = false;  // with images that they write: OpenGL 4.3, ES 3.1
};

/// Whether the processor draws where GL_RENDERER is this: llvmpipe, SwiftShader and their like.
bool draws_in_software(const std::string& renderer);

class Context {
 public:
  /// Creates a context and makes it current. Throws ContextError with what was tried and what to
  /// install. Not in a browser, where a canvas has one: external().
  static Context create(const ContextRequest& request);

  using GetProcAddress = void* (*)(const char* name);
  /// Takes over a context that is current on this thread (a window's); never destroys it.
  static Context external(GetProcAddress get_proc_address, Api api);

  Context(Context&&) noexcept;
  Context& operator=(Context&&) noexcept;
  /// Destroys the context, and leaves none current if it was. Another that is current stays so.
  ~Context();

  /// Makes this context current on the calling thread and loads its functions.
  void make_current();

  Backend backend() const;
  /// The library's own way to find functions, for whoever shares this context.
  GetProcAddress get_proc_address() const { return platform_->get_proc_address(); }
  const Capabilities& capabilities() const { return capabilities_; }
  /// "EGL, OpenGL 4.5 core" and the like.
  std::string description() const;

  /// A context of one library; implemented in context_egl.cpp and context_osmesa.cpp.
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

/// Throws ContextError where the device has been reset since the current context was made (its
/// driver crashed or was replaced, a draw took too long): nothing is drawn from then on. Our
/// contexts ask to be told; whether one of somebody else's (Backend::external) does, its maker
/// knows. Waits for nothing.
void throw_if_lost();

}  // namespace tureen::gl
