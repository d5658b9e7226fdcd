// Arguments of the commands that read a scene.
#pragma once

#include <filesystem>

#include "formats/scene_file.hpp"
#include "web/engine/values.hpp"

namespace tureen::web {

/// The scene among the files that the page put into this instance's file system. {"folder",
/// "paths"}: the first path, relative to the folder, that a reader recognises; otherwise
/// the last, whose reader reports the error. Makes the folder current, so that errors have the same
/// file names as the page.
std::filesystem::path scene_path(const Json& arguments);

/// {"max_splats"?, "lod"?}
ReadOptions read_options(const Json& arguments);

}  // namespace tureen::web
