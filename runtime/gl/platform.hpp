// Internal to runtime/gl: the libraries that can make a context without a window.
#pragma once

#include <memory>

#include "runtime/gl/context.hpp"

namespace tureen::gl {

/// Both throw ContextError with a reason ("libEGL.so.1 is not installed", ..).
std::unique_ptr<Context::Platform> create_egl(const ContextRequest& request);
std::unique_ptr<Context::Platform> create_osmesa(const ContextRequest& request);

/// A library opened with dlopen and kept open: GL drivers do not survive being unloaded.
class SharedLibrary {
 public:
  /// Throws ContextError when the library cannot be opened.
  explicit SharedLibrary(const char* name);
  /// Throws ContextError when the symbol is missing.
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
