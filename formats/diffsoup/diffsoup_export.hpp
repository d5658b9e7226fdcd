// The folder that DiffSoup exports for the web (arXiv 2603.27151 and its code):
//   mesh.ply           positions and triangles (formats/diffsoup/diffsoup_mesh.hpp)
//   lut0.png lut1.png  RGBA8 (f0 f1 f2 f3) and (f4 f5 f6 alpha); texel k of face t at linear place
//                      i = t texel_count(level) + k, pixel (i % width, i / width)
//   mlp_weights.json   W1 [16][16], b1, W2 [16][16], b2, W3 [3][16], b3, row by row
//   meta.json          up, level, background, num_faces, num_verts
// All faces have one level. Cameras, names and an origin have no place in it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "formats/scene_file.hpp"

namespace tureen {

/// Whether `folder` is one that holds mesh.ply and lut0.png.
bool is_diffsoup_export(const std::filesystem::path& folder);

/// The name of something in `folder` that is no part of an export and would be lost with it; ""
/// where there is none.
std::string foreign_to_diffsoup_export(const std::filesystem::path& folder);

/// Levels 0..7; any width of the two images as long as their height is ceil(texels / width).
/// Without meta.json the web viewer's defaults hold: level 5, up -y, background black.
///
/// The half that truncation lost: the published exporter writes floor(255 x). Texels that training
/// never touched have an alpha of exactly 1/2, are drawn by the trainer, and arrive as 127, which
/// is not. Where more texels stand at 127 than at 126 and 128 together, which truncation of a
/// pile at 1/2 does and no smooth distribution, those at 127 are read as 128, and a note counts
/// them. Files with "writer": "tureen" in meta.json are rounded well and never changed.
///
/// Throws InputError.
Scene read_diffsoup_export(const std::filesystem::path& folder, const ReadOptions& options = {});

/// Writes the folder whole or not at all; one that is there is replaced if it is an export, and
/// nothing but that, or empty. Bytes are written as they are, floats rounded, alpha on its side of
/// 1/2 (image/quantise.hpp). Face and vertex colours become level 0. Faces of lower levels are
/// refined to the highest. Without a color MLP an inert one is written (f3 = 0). Returns what was
/// lost or added, a sentence each. Throws UsageError for other appearances, other networks than
/// 16-16-16-3 of seven features, no triangles at all, or more texels than an image may hold; and
/// OutputError.
std::vector<std::string> write_diffsoup_export(const Scene& scene,
                                               const std::filesystem::path& folder);

}  // namespace tureen
