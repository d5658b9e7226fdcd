// Internal to runtime/gl: libraries that create contexts without a window.
#pragma once

#include <memory>

#include "runtime/gl/context.hpp"

namespace tureen::gl {

/// Both throw ContextError with a reason ("libEGL.so.1 is not installed", ..).
std::unique_ptr<Context::Platform> create_egl(const ContextRequest& request);
std::unique_ptr<Context::Platform> create_osmesa(const ContextRequest& request);

}  // namespace tureen::gl
