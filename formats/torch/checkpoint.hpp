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
#include "formats/read_options.hpp"
#include "scene/scene.hpp"

namespace tureen {

/// Whether a file with these first bytes (at least 8) was saved by torch, in its zip format or in
/// the older one. read_checkpoint rejects the older one with a hint.
bool is_checkpoint(std::span<const std::byte> head);

/// DiffSoup becomes a LatticeTexture with float texels and its color MLP. The others become
/// TriangleWindows, after activation: those of Triangle Splatting have one colour each, those of
/// Triangle Splatting+ and MeshSplatting one a corner, one sigma for all, and the least opacity of
/// their vertices. Their opacity is at least 0.9999 or 0.999, as in their own readers. Windows with
/// a value that is not finite are dropped. Assumptions and losses are in info.remarks. Throws
/// InputError.
Scene read_checkpoint(const std::filesystem::path& path, const ReadOptions& options = {});
Scene read_checkpoint(Input input, const ReadOptions& options = {});

}  // namespace tureen
