// GL contexts for image tests.
#pragma once

#include <ostream>
#include <string>

#include "runtime/gl/context.hpp"

namespace tureen::test {

struct NamedContext {
  const char* name;  // the name of a test parameter
  gl::ContextRequest request;
};
inline void PrintTo(const NamedContext& context, std::ostream* out) { *out << context.name; }

inline constexpr gl::ContextRequest osmesa{.backend = gl::Backend::osmesa};
/// Drivers return the highest compatible version, but the shaders use GLSL 3.30.
inline constexpr gl::ContextRequest egl_core33{
    .backend = gl::Backend::egl, .api = gl::Api::desktop, .major = 3, .minor = 3};
inline constexpr gl::ContextRequest egl_es30{
    .backend = gl::Backend::egl, .api = gl::Api::es, .major = 3, .minor = 0};

inline constexpr NamedContext every_context[] = {
    {"osmesa", osmesa}, {"egl_core33", egl_core33}, {"egl_es30", egl_es30}};

}  // namespace tureen::test
