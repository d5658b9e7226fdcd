// Internal to runtime/gl: libraries that create contexts without a window.
#pragma once

#include <memory>

#include "runtime/gl/context.hpp"

namespace tureen::gl {

/// Both throw ContextError with a reason ("libEGL.so.1 is not installed", ..).
std::unique_ptr<Context::Platform> create_egl(const ContextRequest& request);
std::unique_ptr<Context::Platform> create_osmesa(const ContextRequest& request);

/// A library opened with dlopen and never closed, since GL drivers fail after unloading.
class SharedLibrary {
 public:
  /// Throws ContextError if the library cannot be opened.
  explicit SharedLibrary(const char* name);
  /// Throws ContextError if the symbol is missing.
  void* symbol(const char* name) const;
  template <class Function>
  void load(Function& function, const char* name) const {
    function = reinterpret_cast<Function>(symbol(name));
  }

 private:
  const char* name_;
  void* handle_;
};

}  // namespace tureen::gl
