// glTF 2.0, .gltf and .glb: the door to our own files (formats/tureen_glb/tureen_glb.hpp) and the
// reader of everybody else's.
//
// What is read of a foreign file: triangles, strips and fans of all nodes of the scene, indexed or
// not, any component type, normalised, quantised (KHR_mesh_quantization) or sparse; vertex colours
// (COLOR_0); the base colour's factor and texture with its sampler, KHR_texture_transform and alpha
// mode; perspective cameras. Materials are drawn unlit (KHR_materials_unlit or not): a trained soup
// has its light baked in.
// What is not: lines and points, animation, skins, morph targets, lights, emission, normal maps,
// mip levels. A note says so where the file has them and it matters. BLEND is drawn as MASK with a
// cutoff of 0.5. A file that requires an extension that we lack is refused by the extension's name.
//
// Nothing outside of the scene's folder is opened, and all that the file says is checked against
// the bytes that are there; instancing may not make more vertices than 2^24 or the file's bytes.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

#include "base/input.hpp"
#include "formats/scene_file.hpp"
#include "scene/scene.hpp"

namespace tureen {

/// Whether a file that begins like this is one to try: the magic of a GLB, or a JSON object that
/// speaks of an "asset" early on.
bool is_gltf(std::span<const std::byte> head);

/// Reads a .gltf, or a .glb of ours or of others; told by content. The soup has VertexColors where
/// no material has a texture, UvTextures otherwise. Throws InputError whose reason begins with the
/// place in the JSON, as in "accessors[3]: ..".
Scene read_gltf_or_glb(const std::filesystem::path& path, const ReadOptions& options = {});

/// The same of bytes from anywhere: the files that they name lie in `folder`.
Scene read_gltf_or_glb(Input& input, const std::filesystem::path& folder,
                       const ReadOptions& options = {});

}  // namespace tureen
