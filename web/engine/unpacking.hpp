// A scene that arrives at the instance of the page: its head in the buffer, its blobs in
// Module.blobs.
#pragma once

#include "runtime/renderer.hpp"
#include "web/engine/commands.hpp"

namespace tureen::web {

/// The buffer is a head, which waits to be unpacked.
Json take_head(const Json& arguments);

/// The scene of the head that was taken, which is forgotten.
Renderer unpacked(const gl::Context& context);

}  // namespace tureen::web
