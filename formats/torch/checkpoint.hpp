// Torch checkpoints of trained triangles, identified by their keys:
//   DiffSoup             final_params.pt               feat_acc, alpha_acc, V, F, color_mlp, Rmax
//   Triangle Splatting   point_cloud_state_dict.pt     triangles_points [N,3,3], sigma, opacity, ..
//   Triangle Splatting+,
//   MeshSplatting        point_cloud_state_dict.pt     triangles_points [V,3], _triangle_indices ..
// (arXiv 2603.27151, 2505.19175, 2509.25122, 2512.06818). No Python is needed and no code is
// executed: see formats/torch/pickle.hpp.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

#include "base/input.hpp"
#include "formats/scene_file.hpp"

namespace tureen {

/// Whether a file with these first bytes (at least 8) was saved by torch, in its zip format or in
/// the older one. read_checkpoint rejects the older one with a hint.
bool is_checkpoint(std::span<const std::byte> head);

/// DiffSoup becomes a LatticeTexture with float texels and its color MLP. Triangle Splatting
/// becomes TriangleWindows, after activation. Triangle Splatting+ and MeshSplatting become
/// harmonics on shared vertices: their final models are opaque, since their own readers set an
/// opacity of at least 0.9999. Assumptions are in info.remarks. Throws InputError.
Scene read_checkpoint(const std::filesystem::path& path, const ReadOptions& options = {});
Scene read_checkpoint(Input input, const ReadOptions& options = {});

}  // namespace tureen
