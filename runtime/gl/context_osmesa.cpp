// OSMesa: Mesa's software rasteriser drawing into our memory. Its header clashes with GL loaders,
// so the few required declarations are here. Mesa 25.1 and later do not include OSMesa.
#include <array>
#include <vector>

#include "base/error.hpp"
#include "base/platform/shared_library.hpp"
#include "runtime/gl/platform.hpp"

namespace tureen::gl {

namespace {

using OSMesaContext = void*;

// From GL/osmesa.h.
constexpr int osmesa_format = 0x22;
constexpr int osmesa_rgba = 0x1908;
constexpr int osmesa_depth_bits = 0x30;
constexpr int osmesa_profile = 0x33;
constexpr int osmesa_core_profile = 0x34;
constexpr int osmesa_major_version = 0x36;
constexpr int osmesa_minor_version = 0x37;
constexpr unsigned gl_unsigned_byte = 0x1401;

SharedLibrary open_library() {
  // Version 8 is in Debian and Fedora; 6 is the older one.
  try {
    return SharedLibrary("libOSMesa.so.8");
  } catch (const ContextError&) {
    return SharedLibrary("libOSMesa.so.6");
  }
}

struct OsMesa {
  SharedLibrary library = open_library();
  OSMesaContext (*create_context)(const int*, OSMesaContext);
  void (*destroy_context)(OSMesaContext);
  unsigned char (*make_current)(OSMesaContext, void*, unsigned, int, int);
  OSMesaContext (*get_current_context)();
  void* (*get_proc_address)(const char*);

  OsMesa() {
    library.load(create_context, "OSMesaCreateContextAttribs");
    library.load(destroy_context, "OSMesaDestroyContext");
    library.load(make_current, "OSMesaMakeCurrent");
    library.load(get_current_context, "OSMesaGetCurrentContext");
    library.load(get_proc_address, "OSMesaGetProcAddress");
  }
};

const OsMesa& osmesa() {
  static const OsMesa loaded;
  return loaded;
}

class OsMesaPlatform final : public Context::Platform {
 public:
  explicit OsMesaPlatform(OSMesaContext context) : context_(context) {}
  ~OsMesaPlatform() override {
    // Only if this context is current: another one may have become current.
    if (osmesa().get_current_context() == context_)
      osmesa().make_current(nullptr, nullptr, 0, 0, 0);
    osmesa().destroy_context(context_);
  }
  void make_current() override {
    // OSMesa requires a window buffer. All drawing goes to our own framebuffers.
    if (!osmesa().make_current(context_, window_.data(), gl_unsigned_byte, 1, 1))
      throw ContextError("OSMesaMakeCurrent failed");
  }
  Context::GetProcAddress get_proc_address() const override { return osmesa().get_proc_address; }
  Backend backend() const override { return Backend::osmesa; }

 private:
  OSMesaContext context_;
  std::array<unsigned char, 4> window_{};
};

}  // namespace

std::unique_ptr<Context::Platform> create_osmesa(const ContextRequest& request) {
  if (request.api == Api::es) throw ContextError("OSMesa does not support OpenGL ES");
  struct Version {
    int major, minor;
  };
  // 4.6 fails; 4.5 is the highest version of Mesa's software rasteriser.
  const std::vector<Version> versions = request.major > 0
                                            ? std::vector<Version>{{request.major, request.minor}}
                                            : std::vector<Version>{{4, 5}, {4, 1}, {3, 3}};
  for (const Version version : versions) {
    const int attributes[] = {osmesa_format,
                              osmesa_rgba,
                              osmesa_depth_bits,
                              24,
                              osmesa_profile,
                              osmesa_core_profile,
                              osmesa_major_version,
                              version.major,
                              osmesa_minor_version,
                              version.minor,
                              0};
    if (OSMesaContext context = osmesa().create_context(attributes, nullptr)) {
      auto platform = std::make_unique<OsMesaPlatform>(context);
      platform->make_current();
      return platform;
    }
  }
  throw ContextError("OSMesa offers no OpenGL 3.3 core context");
}

}  // namespace tureen::gl
