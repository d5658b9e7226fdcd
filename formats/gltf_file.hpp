// Files of glTF 2.0, .gltf and .glb: ours (tureen_glb/tureen_glb.hpp) and those of others
// (gltf/gltf.hpp). The extension in the JSON tells them apart.
//
// No file outside the scene's folder is opened, and all values are checked against the available
// bytes.
#pragma once

#include <filesystem>

#include "base/input.hpp"
#include "formats/gltf/gltf.hpp"
#include "formats/read_options.hpp"
#include "scene/scene.hpp"

namespace tureen {

/// The decoders that this program links: none in a page, whose programs give theirs.
extern const GltfDecoders gltf_decoders;

/// Throws InputError.
Scene read_gltf_or_glb(const std::filesystem::path& path, const ReadOptions& options = {},
                       const GltfDecoders& decoders = gltf_decoders);

/// Reads bytes from any source. Files that they name lie in `folder`. Throws InputError.
Scene read_gltf_or_glb(Input& input, const std::filesystem::path& folder,
                       const ReadOptions& options = {},
                       const GltfDecoders& decoders = gltf_decoders);

}  // namespace tureen
