// EGL without a surface: on a device (EGL_EXT_platform_device), for vendors' EGL, or on
// EGL_MESA_platform_surfaceless. The few required declarations are here, so that the build needs no
// EGL headers.
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/platform/shared_library.hpp"
#include "runtime/gl/platform.hpp"

namespace tureen::gl {

namespace {

using EGLDisplay = void*;
using EGLConfig = void*;
using EGLContext = void*;
using EGLSurface = void*;
using EGLDevice = void*;
using EGLint = std::int32_t;
using EGLBoolean = unsigned;

// From the EGL registry (egl.xml).
constexpr EGLint egl_none = 0x3038;
constexpr EGLint egl_extensions = 0x3055;
constexpr EGLint egl_surface_type = 0x3033;
constexpr EGLint egl_renderable_type = 0x3040;
constexpr EGLint egl_opengl_bit = 0x0008;
constexpr EGLint egl_opengl_es3_bit = 0x0040;
constexpr unsigned egl_opengl_api = 0x30A2;
constexpr unsigned egl_opengl_es_api = 0x30A0;
constexpr EGLint egl_context_major_version = 0x3098;
constexpr EGLint egl_context_minor_version = 0x30FB;
constexpr EGLint egl_context_profile_mask = 0x30FD;
constexpr EGLint egl_context_reset_strategy = 0x31BD;
constexpr EGLint egl_lose_context_on_reset = 0x31BF;
constexpr EGLint egl_core_profile_bit = 0x0001;
constexpr unsigned egl_platform_surfaceless = 0x31DD;
constexpr unsigned egl_platform_device = 0x313F;

struct Egl {
  SharedLibrary library{"libEGL.so.1"};
  void* (*get_proc_address)(const char*);
  const char* (*query_string)(EGLDisplay, EGLint);
  EGLBoolean (*initialize)(EGLDisplay, EGLint*, EGLint*);
  EGLBoolean (*bind_api)(unsigned);
  EGLBoolean (*choose_config)(EGLDisplay, const EGLint*, EGLConfig*, EGLint, EGLint*);
  EGLContext (*create_context)(EGLDisplay, EGLConfig, EGLContext, const EGLint*);
  EGLBoolean (*destroy_context)(EGLDisplay, EGLContext);
  EGLBoolean (*make_current)(EGLDisplay, EGLSurface, EGLSurface, EGLContext);
  EGLContext (*get_current_context)();
  EGLDisplay (*get_platform_display)(unsigned, void*, const EGLint*) = nullptr;
  EGLBoolean (*query_devices)(EGLint, EGLDevice*, EGLint*) = nullptr;

  Egl() {
    library.load(get_proc_address, "eglGetProcAddress");
    library.load(query_string, "eglQueryString");
    library.load(initialize, "eglInitialize");
    library.load(bind_api, "eglBindAPI");
    library.load(choose_config, "eglChooseConfig");
    library.load(create_context, "eglCreateContext");
    library.load(destroy_context, "eglDestroyContext");
    library.load(make_current, "eglMakeCurrent");
    library.load(get_current_context, "eglGetCurrentContext");
    load_extension(get_platform_display, "eglGetPlatformDisplayEXT");
    load_extension(query_devices, "eglQueryDevicesEXT");
  }

  template <class Function>
  void load_extension(Function& function, const char* name) {
    function = reinterpret_cast<Function>(get_proc_address(name));
  }
};

const Egl& egl() {
  static const Egl loaded;
  return loaded;
}

/// The displays to try, best first: devices of a vendor (a GPU before Mesa's software device, as
/// EGL lists them), then Mesa's surfaceless platform.
std::vector<EGLDisplay> displays() {
  std::vector<EGLDisplay> found;
  if (!egl().get_platform_display) throw ContextError("libEGL.so.1 lacks eglGetPlatformDisplayEXT");
  const char* extensions = egl().query_string(nullptr, egl_extensions);
  if (extensions && std::strstr(extensions, "EGL_MESA_platform_surfaceless"))
    found.push_back(egl().get_platform_display(egl_platform_surfaceless, nullptr, nullptr));
  if (extensions && std::strstr(extensions, "EGL_EXT_platform_device") && egl().query_devices) {
    EGLDevice devices[16];
    EGLint count = 0;
    if (egl().query_devices(16, devices, &count)) {
      std::vector<EGLDisplay> on_devices;
      for (EGLint i = 0; i < count; ++i)
        on_devices.push_back(egl().get_platform_display(egl_platform_device, devices[i], nullptr));
      found.insert(found.begin(), on_devices.begin(), on_devices.end());
    }
  }
  return found;
}

class EglPlatform final : public Context::Platform {
 public:
  EglPlatform(EGLDisplay display, EGLContext context, unsigned api)
      : display_(display), context_(context), api_(api) {}
  ~EglPlatform() override {
    // Only if this context is current: another one may have become current.
    if (egl().get_current_context() == context_)
      egl().make_current(display_, nullptr, nullptr, nullptr);
    egl().destroy_context(display_, context_);
    // All contexts of the process share the display, so it stays initialised.
  }
  void make_current() override {
    egl().bind_api(api_);
    if (!egl().make_current(display_, nullptr, nullptr, context_))
      throw ContextError("eglMakeCurrent failed without a surface");
  }
  Context::GetProcAddress get_proc_address() const override { return egl().get_proc_address; }
  Backend backend() const override { return Backend::egl; }

 private:
  EGLDisplay display_;
  EGLContext context_;
  unsigned api_;
};

EGLContext create_on(EGLDisplay display, const ContextRequest& request, int major, int minor) {
  const bool es = request.api == Api::es;
  const EGLint config_attributes[] = {egl_surface_type, 0, egl_renderable_type,
                                      es ? egl_opengl_es3_bit : egl_opengl_bit, egl_none};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (!egl().choose_config(display, config_attributes, &config, 1, &count) || count < 1)
    return nullptr;
  std::vector<EGLint> attributes = {egl_context_major_version, major, egl_context_minor_version,
                                    minor};
  if (!es) attributes.insert(attributes.end(), {egl_context_profile_mask, egl_core_profile_bit});
  // Requests reset notification for throw_if_lost(). EGL supports it from 1.5 on.
  std::vector<EGLint> told = attributes;
  told.insert(told.end(), {egl_context_reset_strategy, egl_lose_context_on_reset, egl_none});
  attributes.push_back(egl_none);
  const auto create = [&](const std::vector<EGLint>& wanted) {
    return egl().create_context(display, config, nullptr, wanted.data());
  };
  EGLContext context = create(told);
  return context ? context : create(attributes);
}

}  // namespace

std::unique_ptr<Context::Platform> create_egl(const ContextRequest& request) {
  struct Version {
    int major, minor;
  };
  std::vector<Version> versions;
  if (request.major > 0)
    versions = {{request.major, request.minor}};
  else if (request.api == Api::es)
    versions = {{3, 2}, {3, 1}, {3, 0}};
  else
    versions = {{4, 6}, {4, 5}, {4, 1}, {3, 3}};

  const unsigned api = request.api == Api::es ? egl_opengl_es_api : egl_opengl_api;
  for (EGLDisplay display : displays()) {
    if (!display || !egl().initialize(display, nullptr, nullptr)) continue;
    if (!egl().bind_api(api)) continue;
    for (const Version version : versions)
      if (EGLContext context = create_on(display, request, version.major, version.minor)) {
        auto platform = std::make_unique<EglPlatform>(display, context, api);
        platform->make_current();
        return platform;
      }
  }
  throw ContextError(std::string("EGL offers no OpenGL") +
                     (request.api == Api::es ? " ES 3.0" : " 3.3 core") +
                     " context without a display");
}

}  // namespace tureen::gl
