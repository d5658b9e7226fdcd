#include "runtime/gl/context.hpp"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <iterator>
#include <stdexcept>

#include "base/error.hpp"
#include "runtime/gl/api.hpp"
#include "runtime/gl/platform.hpp"

#ifdef __EMSCRIPTEN__
#include <emscripten/html5.h>
#endif

namespace tureen::gl {

namespace {

class ExternalPlatform final : public Context::Platform {
 public:
  explicit ExternalPlatform(Context::GetProcAddress loader) : get_proc_address_(loader) {}
  void make_current() override {}
  Context::GetProcAddress get_proc_address() const override { return get_proc_address_; }
  Backend backend() const override { return Backend::external; }

 private:
  Context::GetProcAddress get_proc_address_;
};

std::string text_of(GLenum name) {
  const auto* text = reinterpret_cast<const char*>(glGetString(name));
  return text ? text : "unknown";
}

int integer_of(GLenum name) {
  GLint value = 0;
  glGetIntegerv(name, &value);
  return value;
}

bool contains(const std::string& text, const char* part) {
  return text.find(part) != std::string::npos;
}

#if !defined NDEBUG && !defined __EMSCRIPTEN__
void GLAD_API_PTR report(GLenum, GLenum type, GLuint, GLenum, GLsizei, const GLchar* message,
                         const void*) {
  // Performance hints and notices are not errors.
  if (type == GL_DEBUG_TYPE_ERROR) std::fprintf(stderr, "OpenGL: %s\n", message);
}
#endif

#ifndef __EMSCRIPTEN__
bool has_extension(const char* name) {
  for (int i = 0; i < integer_of(GL_NUM_EXTENSIONS); ++i)
    if (const auto* text = reinterpret_cast<const char*>(glGetStringi(GL_EXTENSIONS, GLuint(i)));
        text && std::strcmp(text, name) == 0)
      return true;
  return false;
}
#endif

bool has_timer_queries(Api api) {
#ifdef __EMSCRIPTEN__
  (void)api;
  return false;
#else
  if (api == Api::es) return has_extension("GL_EXT_disjoint_timer_query");
  // Core since 3.3. A device without a clock reports 0 bits.
  GLint bits = 0;
  glGetQueryiv(GL_TIMESTAMP, GL_QUERY_COUNTER_BITS, &bits);
  return bits > 0;
#endif
}

/// Whether the context has what OpenGL has in its core, and ES and WebGL as an extension with this
/// name, without "GL_".
bool has_as_extension(Api api, const std::string& name) {
#ifdef __EMSCRIPTEN__
  (void)api;
  return emscripten_webgl_enable_extension(emscripten_webgl_get_current_context(), name.c_str());
#else
  return api == Api::desktop || has_extension(("GL_" + name).c_str());
#endif
}

bool has_clip_control(Api api, int version) {
#ifdef __EMSCRIPTEN__
  (void)api, (void)version;
  return false;  // Emscripten 3.1 cannot reach EXT_clip_control
#else
  return api == Api::desktop ? glClipControl != nullptr && version >= 45
                             : glClipControlEXT != nullptr;
#endif
}

/// Whether one call can draw many runs of vertices.
bool has_multi_draw(Api api) {
#ifdef __EMSCRIPTEN__
  (void)api;
  return emscripten_webgl_enable_WEBGL_multi_draw(emscripten_webgl_get_current_context());
#else
  return api == Api::desktop;
#endif
}

/// GL_RENDERER of a browser is its own name; some report the device as UNMASKED_RENDERER_WEBGL.
std::string renderer_name() {
#ifdef __EMSCRIPTEN__
  constexpr GLenum unmasked_renderer = 0x9246;
  if (emscripten_webgl_enable_extension(emscripten_webgl_get_current_context(),
                                        "WEBGL_debug_renderer_info"))
    return text_of(unmasked_renderer);
#endif
  return text_of(GL_RENDERER);
}

bool has_compute_shaders(Api api, int version) {
#ifdef __EMSCRIPTEN__
  (void)api, (void)version;
  return false;
#else
  return version >= (api == Api::desktop ? 43 : 31);
#endif
}

Capabilities query_capabilities(Api api) {
  Capabilities result;
  result.api = api;
  result.major = integer_of(GL_MAJOR_VERSION);
  result.minor = integer_of(GL_MINOR_VERSION);
  result.renderer = renderer_name();
  result.vendor = text_of(GL_VENDOR);
  result.version = text_of(GL_VERSION);
  const bool desktop = api == Api::desktop;
  const int version = 10 * result.major + result.minor;
  if (version < (desktop ? 33 : 30))
    throw ContextError("OpenGL " + result.version + " is too old: Tureen needs 3.3 core or ES 3.0");
  result.clip_control = has_clip_control(api, version);
  result.multi_draw = has_multi_draw(api);
  result.timer_queries = has_timer_queries(api);
  result.software = draws_in_software(result.renderer);
  result.max_texture_size = integer_of(GL_MAX_TEXTURE_SIZE);
  GLint viewport[2] = {0, 0};
  glGetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport);
  result.max_image_side = std::min(
      {result.max_texture_size, integer_of(GL_MAX_RENDERBUFFER_SIZE), viewport[0], viewport[1]});
  result.max_array_layers = integer_of(GL_MAX_ARRAY_TEXTURE_LAYERS);
  result.compute_shaders = has_compute_shaders(api, version);
  result.float_targets = has_as_extension(api, "EXT_color_buffer_float");
  result.float_blending = result.float_targets && has_as_extension(api, "EXT_float_blend");
  result.norm16_targets = has_as_extension(api, "EXT_texture_norm16");
  return result;
}

}  // namespace

bool draws_in_software(const std::string& renderer) {
  // The renderers of Mesa (two), Chromium, Windows without a driver (WARP, OpenGL 1.1) and macOS.
  constexpr const char* names[] = {"llvmpipe",    "softpipe",
                                   "SwiftShader", "Microsoft Basic Render Driver",
                                   "GDI Generic", "Apple Software Renderer"};
  return std::any_of(std::begin(names), std::end(names),
                     [&](const char* name) { return contains(renderer, name); });
}

void throw_if_lost() {
#ifndef __EMSCRIPTEN__  // a canvas reports it by events
  // OpenGL 4.5 and ES 3.2 have this query. Older drivers end the program.
  if (glGetGraphicsResetStatus && glGetGraphicsResetStatus() != GL_NO_ERROR)
    throw ContextError(
        "the graphics device was reset while drawing (its driver failed or was replaced, or a draw "
        "took too long), and its buffers and textures are lost",
        "start the program again");
#endif
}

#ifndef NDEBUG
void check(const char* where) {
  if (const GLenum error = glGetError(); error != GL_NO_ERROR)
    throw std::logic_error(std::string("OpenGL error ") + std::to_string(error) + " in " + where);
}
#endif

#ifndef __EMSCRIPTEN__
Context Context::create(const ContextRequest& request) {
  std::string tried;
  const auto attempt = [&](auto create_platform, const char* name) -> std::unique_ptr<Platform> {
    try {
      return create_platform(request);
    } catch (const ContextError& error) {
      tried += std::string(tried.empty() ? "" : "; ") + name + ": " + error.reason();
      return nullptr;
    }
  };
  std::unique_ptr<Platform> platform;
  if (request.backend != Backend::osmesa) platform = attempt(create_egl, "EGL");
  if (!platform && request.backend != Backend::egl) platform = attempt(create_osmesa, "OSMesa");
  if (!platform)
    throw ContextError("no OpenGL context can be created (" + tried + ")",
                       "install a GPU driver with EGL, or Mesa's software renderer: on Debian and "
                       "Ubuntu, apt-get install libegl1 libgl1-mesa-dri, or libosmesa6");
  return Context(std::move(platform), request.api);
}

#endif

Context Context::external(GetProcAddress get_proc_address, Api api) {
  return Context(std::make_unique<ExternalPlatform>(get_proc_address), api);
}

Context::Context(std::unique_ptr<Platform> platform, Api api) : platform_(std::move(platform)) {
  capabilities_.api = api;
  make_current();
  capabilities_ = query_capabilities(api);
#if !defined NDEBUG && !defined __EMSCRIPTEN__
  if (glDebugMessageCallback) {
    glEnable(GL_DEBUG_OUTPUT);
    glDebugMessageCallback(report, nullptr);
  }
#endif
}

Context::Context(Context&&) noexcept = default;
Context& Context::operator=(Context&&) noexcept = default;
Context::~Context() = default;

void Context::make_current() {
  platform_->make_current();
#ifndef __EMSCRIPTEN__
  // glad keeps one table of functions. A context of another library needs its own functions in it.
  const auto load = reinterpret_cast<GLADloadfunc>(platform_->get_proc_address());
  const int loaded = capabilities_.api == Api::es ? gladLoadGLES2(load) : gladLoadGL(load);
  if (!loaded) throw ContextError("the context does not provide the OpenGL functions");
#endif
}

Backend Context::backend() const { return platform_->backend(); }

std::string Context::description() const {
  static constexpr const char* names[] = {"automatic", "EGL", "OSMesa", "external"};
  return std::string(names[static_cast<int>(backend())]) +
         (capabilities_.api == Api::es ? ", OpenGL ES " : ", OpenGL ") +
         std::to_string(capabilities_.major) + "." + std::to_string(capabilities_.minor) +
         (capabilities_.api == Api::es ? "" : " core");
}

}  // namespace tureen::gl
