// Unpacks a scene in the page's instance: the head is in the buffer, the blobs are in Module.blobs.
#pragma once

#include "runtime/prepared_scene.hpp"
#include "web/engine/commands.hpp"

namespace tureen::web {

/// Takes the head of a scene from the buffer, for unpacked().
Json take_head(const Json& arguments);

/// The scene of that head; frees the head. Its sources read Module.blobs.
PreparedScene unpacked();

}  // namespace tureen::web
