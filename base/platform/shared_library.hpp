// A library opened at run time and never closed, since GL drivers fail after unloading.
#pragma once

namespace tureen {

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

}  // namespace tureen
