// Unpacks a scene in the page's instance: its head comes first, then blocks of its stores if it is
// large. The other blobs are in Module.blobs.
#pragma once

#include "runtime/prepared_scene.hpp"
#include "web/engine/engine.hpp"

namespace tureen::web {

/// Takes the head of a scene from the buffer, for unpacked(). Forgets an earlier one.
void take_head(Engine& engine);

/// {"blob", "offset"}: uploads the bytes in the buffer (ArrivingScene::upload).
void upload_block(Engine& engine, const Json& arguments);

/// The scene of the head. Its sources read Module.blobs, except those that were uploaded.
PreparedScene unpacked(Engine& engine);

}  // namespace tureen::web
