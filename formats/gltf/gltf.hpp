// Foreign glTF 2.0. Of our own files, it reads what any viewer shows.
//
// Supported: triangles, strips and fans in all nodes of the scene, indexed or not,
// any component type, normalised, quantised (KHR_mesh_quantization) or sparse. Also vertex colours
// (COLOR_0); the base colour's factor and texture with its sampler, KHR_texture_transform and alpha
// mode; normals; perspective cameras. Materials are drawn unlit, with or without
// KHR_materials_unlit, since a trained soup has its light baked in. Mirrors and glass are layers of
// their own, for rays.
// Gaussian splats (KHR_gaussian_splatting) become a layer for each primitive of a node:
// formats/gltf/gltf_splats.hpp. They may be SPZ files. Buffer views may be compressed by
// EXT_meshopt_compression.
// Not supported: lines and other points, animation, skins, morph targets, lights, emission, normal
// maps, mip levels. A remark reports them if they matter. BLEND is drawn as MASK with a cutoff of
// 0.5. A file that requires an unsupported extension is rejected with the extension's name.
//
// No file outside the scene's folder is opened, and all values are checked against the available
// bytes. Instancing may create at most as many vertices as the larger of 2^24 and the file's bytes.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

#include "base/input.hpp"
#include "base/json/json_view.hpp"
#include "formats/read_options.hpp"
#include "scene/scene.hpp"

namespace tureen {

struct GlbContainer;

/// Reads an SPZ file (formats/splat/spz.hpp).
using ReadSpz = Scene (*)(Input&, const ReadOptions&);
/// Decompresses a buffer view (formats/gltf/gltf_meshopt.hpp).
using DecodeMeshopt = std::vector<std::byte> (*)(const JsonView& extension,
                                                 std::span<const std::byte> stored, MemoryBudget);

/// What decodes compressed content. Null: not supported; a file that requires it is rejected.
struct GltfDecoders {
  ReadSpz spz = nullptr;
  DecodeMeshopt meshopt = nullptr;
};

/// Whether a file with these first bytes may be glTF: the magic of a GLB, or a JSON object with an
/// early "asset".
bool is_gltf(std::span<const std::byte> head);

/// The JSON of a .gltf file, without a binary chunk. Throws InputError.
GlbContainer read_gltf_json(Input& input);

/// Reads the scene of a .gltf or .glb. The triangles of each mirror or glass are a layer, and all
/// others one soup, the first layer; a file without others has no such layer. A soup has
/// VertexColors if none of its materials has a texture, otherwise UvTextures. Files that the
/// document names lie in `folder`. Throws InputError; its reason begins with the place in the JSON,
/// as in "accessors[3]: ..".
Scene read_gltf(Input& input, GlbContainer glb, const std::filesystem::path& folder,
                const ReadOptions& options, const GltfDecoders& decoders = {});

}  // namespace tureen
