// Unpacks a scene in the page's instance: the head is in the buffer, the blobs are in Module.blobs,
// or arrive before in blocks.
#pragma once

#include "runtime/prepared_scene.hpp"
#include "web/engine/commands.hpp"

namespace tureen::web {

/// Takes the head of a scene from the buffer, for unpacked(). Forgets an earlier one.
Json take_head(const Json& arguments);

/// {"blob", "offset"}: uploads the bytes in the buffer to the store of this blob. The blocks of a
/// blob arrive in order, and all of them, before those of another. Throws DeviceLimitError.
Json upload_block(const Json& arguments);

/// Forgets the scene of the head, and frees its memory on the device.
Json forget_head(const Json& arguments);

/// The scene of the head. Its sources read Module.blobs, except those that were uploaded.
PreparedScene unpacked();

}  // namespace tureen::web
