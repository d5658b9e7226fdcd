// Complete GLSL for a context from the files of shaders/. It adds the version line (the oldest
// version that we support, or the oldest with compute shaders for those), precisions, and constants
// from a typed configuration. It resolves #include "file", each file once.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "runtime/gl/context.hpp"

namespace tureen {

struct ShaderSource {
  std::string_view file;  // such as "shading.frag"; compute shaders end with ".comp"
  /// Becomes `#define NAME VALUE`.
  std::map<std::string, std::string> constants = {};
  /// Texts that replace #include files of these names (generated code).
  std::map<std::string, std::string> generated = {};
};

/// Asserts that every included file exists.
std::string assemble(const ShaderSource& source, gl::Api api);

}  // namespace tureen
