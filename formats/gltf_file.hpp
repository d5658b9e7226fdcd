// Files of glTF 2.0, .gltf and .glb: ours (tureen_glb/tureen_glb.hpp) and those of others
// (gltf/gltf.hpp). The extension in the JSON tells them apart.
//
// No file outside the scene's folder is opened, and all values are checked against the available
// bytes.
#pragma once

#include <filesystem>

#include "base/input.hpp"
#include "formats/read_options.hpp"
#include "scene/scene.hpp"

namespace tureen {

/// Throws InputError.
Scene read_gltf_or_glb(const std::filesystem::path& path, const ReadOptions& options = {});

/// Reads bytes from any source. Files that they name lie in `folder`. Throws InputError.
Scene read_gltf_or_glb(Input& input, const std::filesystem::path& folder,
                       const ReadOptions& options = {});

}  // namespace tureen
