// EGL without a surface: on a device (EGL_EXT_platform_device), for vendors' EGL, or on
// EGL_MESA_platform_surfaceless. The build needs EGL's headers (Debian: libegl-dev), not its
// library.
#define EGL_NO_PLATFORM_SPECIFIC_TYPES
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <cstring>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/platform/shared_library.hpp"
#include "runtime/gl/platform.hpp"

namespace tureen::gl {

namespace {

struct Egl {
  SharedLibrary library{"libEGL.so.1"};
  Context::GetProcAddress get_proc_address;
  decltype(&eglQueryString) query_string;
  decltype(&eglInitialize) initialize;
  decltype(&eglBindAPI) bind_api;
  decltype(&eglChooseConfig) choose_config;
  decltype(&eglCreateContext) create_context;
  decltype(&eglDestroyContext) destroy_context;
  decltype(&eglMakeCurrent) make_current;
  decltype(&eglGetCurrentContext) get_current_context;
  PFNEGLGETPLATFORMDISPLAYEXTPROC get_platform_display = nullptr;
  PFNEGLQUERYDEVICESEXTPROC query_devices = nullptr;

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
  const char* extensions = egl().query_string(nullptr, EGL_EXTENSIONS);
  if (extensions && std::strstr(extensions, "EGL_MESA_platform_surfaceless"))
    found.push_back(egl().get_platform_display(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr));
  if (extensions && std::strstr(extensions, "EGL_EXT_platform_device") && egl().query_devices) {
    EGLDeviceEXT devices[16];
    EGLint count = 0;
    if (egl().query_devices(16, devices, &count)) {
      std::vector<EGLDisplay> on_devices;
      for (EGLint i = 0; i < count; ++i)
        on_devices.push_back(
            egl().get_platform_display(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr));
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
  const EGLint config_attributes[] = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE,
                                      es ? EGL_OPENGL_ES3_BIT : EGL_OPENGL_BIT, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (!egl().choose_config(display, config_attributes, &config, 1, &count) || count < 1)
    return nullptr;
  std::vector<EGLint> attributes = {EGL_CONTEXT_MAJOR_VERSION, major, EGL_CONTEXT_MINOR_VERSION,
                                    minor};
  if (!es)
    attributes.insert(attributes.end(),
                      {EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT});
  // Requests reset notification for throw_if_lost(). EGL supports it from 1.5 on.
  std::vector<EGLint> told = attributes;
  told.insert(told.end(), {EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY,
                           EGL_LOSE_CONTEXT_ON_RESET, EGL_NONE});
  attributes.push_back(EGL_NONE);
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

  const unsigned api = request.api == Api::es ? EGL_OPENGL_ES_API : EGL_OPENGL_API;
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
