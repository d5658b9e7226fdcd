// Torch checkpoints of trained triangles, told apart by the keys they hold:
//   DiffSoup             final_params.pt               feat_acc, alpha_acc, V, F, color_mlp, Rmax
//   Triangle Splatting   point_cloud_state_dict.pt     triangles_points [N,3,3], sigma, opacity, ..
//   Triangle Splatting+  and MeshSplatting, the same   triangles_points [V,3], _triangle_indices,
//   ..
//                        file name
// (arXiv 2603.27151, 2505.19175, 2509.25122, 2512.06818). No Python, and nothing is executed:
// see formats/torch/pickle.hpp.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

#include "base/input.hpp"
#include "formats/scene_file.hpp"

namespace tureen {

/// Whether a file that begins with these bytes (8 or more are enough) was saved by torch, in its
/// zip format or in the older one, which read_checkpoint refuses with advice.
bool is_checkpoint(std::span<const std::byte> head);

/// DiffSoup becomes a LatticeTexture of float texels with its color MLP. Triangle Splatting becomes
/// SoftTriangles, after activation. Triangle Splatting+ and MeshSplatting are opaque when they are
/// done (they read themselves back with an opacity of at least 0.9999): harmonics on shared
/// vertices. What was assumed is in info.remarks. Throws InputError.
Scene read_checkpoint(const std::filesystem::path& path, const ReadOptions& options = {});
Scene read_checkpoint(Input input, const ReadOptions& options = {});

}  // namespace tureen
