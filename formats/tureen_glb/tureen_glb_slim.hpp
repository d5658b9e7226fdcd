// The slim file: TUREEN_triangle_soup, version 3, in which geometry and texels are coded with a
// loss that the caller sets (docs/format.md). Read by read_tureen_glb like any file of ours, also
// in the browser; other glTF viewers refuse it, as it has no mesh for them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "formats/tureen_glb/slim_geometry.hpp"
#include "formats/tureen_glb/slim_texels.hpp"
#include "scene/scene.hpp"

namespace tureen {

struct SlimOptions {
  int position_bits = 16;  // encode_slim_geometry
  SlimTexelOptions texels = {};
};

/// The arrays of a slim file.
struct SlimSoup {
  std::vector<std::byte> geometry;
  std::vector<std::byte> texels;
};

/// The soup has a lattice texture and no defect(). Throws UsageError for a vertex that is not
/// finite or more than 2^32 texels.
SlimSoup encode_slim(const TriangleSoup& soup, const SlimOptions& options);

/// What a reader of these makes of them, to look at before it is written: the soup that was encoded
/// but for the loss, with its color MLP and its faces in their order.
TriangleSoup decode_slim(const SlimSoup& slim, const TriangleSoup& encoded);

/// Writes them as a GLB with everything else of the scene; `scene` holds the soup that was encoded.
/// Returns what is lost beside: a sentence each. Throws UsageError where the scene has no lattice
/// texture or what write_tureen_glb refuses, OutputError where the file cannot be written.
std::vector<std::string> write_slim_glb(const Scene& scene, const SlimSoup& slim,
                                        const std::filesystem::path& path);

}  // namespace tureen
