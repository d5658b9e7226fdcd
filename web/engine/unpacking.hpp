// Scenes that arrive at the instance of the page: heads in the buffer, blobs in Module.blobs.
#pragma once

#include "runtime/renderer.hpp"
#include "web/engine/commands.hpp"

namespace tureen::web {

/// Heads that wait to be unpacked: without the scene's preset, and with it where that must be
/// compared.
struct Heads {
  std::vector<std::byte> faithful, quick;
};

/// {"preset"}: the buffer is a head.
Json take_head(const Json& arguments);

/// Those that were taken, which are forgotten.
Heads taken_heads();

/// Its blobs begin at `first_blob`: those of the scene with the preset follow those of the one
/// without.
Renderer unpacked(const gl::Context& context, const std::vector<std::byte>& head,
                  std::size_t first_blob = 0);

}  // namespace tureen::web
