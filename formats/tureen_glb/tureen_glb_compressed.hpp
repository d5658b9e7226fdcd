// The compressed file: TUREEN_triangle_soup, version 3, with lossy geometry and texels of
// adjustable error (docs/format.md). read_tureen_glb reads it, also in the browser. Other glTF
// viewers reject it, since it has no mesh for them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "formats/tureen_glb/compressed_geometry.hpp"
#include "formats/tureen_glb/compressed_texels.hpp"
#include "scene/scene.hpp"

namespace tureen {

struct CompressOptions {
  int position_bits = 16;  // encode_compressed_geometry
  CompressedTexelOptions texels = {};
};

/// The arrays of a compressed file.
struct CompressedSoup {
  std::vector<std::byte> geometry;
  std::vector<std::byte> texels;
};

/// Compresses a soup with a lattice texture and no defect(). Throws UsageError for a non-finite
/// vertex or more than 2^32 texels.
CompressedSoup encode_compressed(const TriangleSoup& soup, const CompressOptions& options);

/// The decoded result before writing: the encoded soup with its losses, its color MLP and its face
/// order.
TriangleSoup decode_compressed(const CompressedSoup& compressed, const TriangleSoup& encoded);

/// Writes a GLB with the arrays and all other data of the scene; `scene` holds the encoded soup.
/// Returns one sentence for each further loss. Throws UsageError if the scene has no lattice
/// texture or write_tureen_glb would reject it. Throws OutputError if the file cannot be written.
std::vector<std::string> write_compressed_glb(const Scene& scene, const CompressedSoup& compressed,
                                              const std::filesystem::path& path);

}  // namespace tureen
