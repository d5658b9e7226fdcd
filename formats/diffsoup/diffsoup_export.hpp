// The folder that DiffSoup exports for the web (arXiv 2603.27151 and its code):
//   mesh.ply           positions and triangles (formats/diffsoup/diffsoup_mesh.hpp)
//   lut0.png lut1.png  RGBA8 (f0 f1 f2 f3) and (f4 f5 f6 alpha); texel k of face t at linear place
//                      i = t texel_count(level) + k, pixel (i % width, i / width)
//   mlp_weights.json   W1 [16][16], b1, W2 [16][16], b2, W3 [3][16], b3, row by row
//   meta.json          up, level, background, num_faces, num_verts
// All faces have one level. The format does not store cameras, names or an origin.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "formats/read_options.hpp"
#include "scene/scene.hpp"

namespace tureen {

/// Whether `folder` contains mesh.ply and lut0.png.
bool is_diffsoup_export(const std::filesystem::path& folder);

/// The name of an entry of `folder` that is not part of an export and would be lost by replacing
/// it; "" if there is none.
std::string foreign_to_diffsoup_export(const std::filesystem::path& folder);

/// Levels 0..7. The two images may have any width with height ceil(texels / width). Without
/// meta.json the web viewer's defaults apply: level 5, up -y, black background.
///
/// Alpha 1/2 is restored after truncation: the published exporter writes floor(255 x). Texels that
/// training never updated have an alpha of exactly 1/2. The trainer draws them, but they are stored
/// as 127, below the threshold. If more texels have 127 than 126 and 128 together, those with 127
/// are read as 128. Truncated values of 1/2 satisfy this condition, smooth distributions do not. A
/// remark counts the changed texels. Files with "writer": "tureen" in meta.json are rounded
/// correctly and never changed.
///
/// Throws InputError.
Scene read_diffsoup_export(const std::filesystem::path& folder, const ReadOptions& options = {});

/// Writes the complete folder or nothing. An existing folder is replaced only if it is empty or an
/// export without other entries. Bytes are written unchanged; floats are rounded, with alpha on its
/// side of 1/2 (image/quantise.hpp). Face and vertex colours become level 0. Faces of lower levels
/// are refined to the highest level. Without a color MLP an inert one is written (f3 = 0). A
/// rotation, scale or mirror of the layer is applied to the vertices. Returns one sentence for each
/// loss or addition. Throws UsageError for several layers, for a layer with such a transform whose
/// colours depend on the view, for other appearances, networks other than 16-16-16-3 with seven
/// features, scenes without triangles, or more texels than an image can have; throws OutputError.
std::vector<std::string> write_diffsoup_export(const Scene& scene,
                                               const std::filesystem::path& folder);

}  // namespace tureen
