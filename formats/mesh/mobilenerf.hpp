// MobileNeRF scenes (arXiv 2208.00277 and its viewers): a folder of
//   mlp.json                    an 11-16-16-3 network, weights [input][output], and obj_num shapes
//   shape{i}.obj                or, for large scenes, in pieces shape{i}_{j}.obj
//   shape{i}.pngfeat0.png       four features a texel; a red byte of 0 is a hole
//   shape{i}.pngfeat1.png       four more
//
// Not supported: the sphere-mapped background of the unbounded scenes and the normalised device
// coordinates of the forward-facing ones. Files in the folder do not distinguish them.
#pragma once

#include <filesystem>

#include "formats/read_options.hpp"
#include "scene/color_mlp.hpp"
#include "scene/scene.hpp"

namespace tureen {

/// Whether `path` is such a folder, its mlp.json or one of its .obj files.
bool is_mobilenerf(const std::filesystem::path& path);

/// All shapes in the folder as one soup of UvTextures: one material a shape, nearest texels, white
/// background, y up, and the camera of the published pages. Missing shapes are listed in
/// info.remarks. Throws InputError, also if all shapes are missing.
///
/// The network is converted to inputs of bytes / 255 and the plain direction from the eye. The
/// published one takes 2 a - 1 for the two alpha features and (x, -z, y) for the direction. Both
/// changes are linear and are folded into its first layer.
Scene read_mobilenerf(const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace tureen
