#include "base/platform/shared_library.hpp"

#include <dlfcn.h>

#include <string>

#include "base/error.hpp"

namespace tureen {

SharedLibrary::SharedLibrary(const char* name)
    : name_(name), handle_(dlopen(name, RTLD_LAZY | RTLD_LOCAL)) {
  if (!handle_) {
    const char* reason = dlerror();
    throw ContextError(reason ? reason : std::string(name) + " cannot be opened");
  }
}

void* SharedLibrary::symbol(const char* name) const {
  void* address = dlsym(handle_, name);
  if (!address) throw ContextError(std::string(name_) + " lacks " + name);
  return address;
}

}  // namespace tureen
