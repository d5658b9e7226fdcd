// Options of all readers. A reader applies those that concern its format.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>

namespace tureen {

/// The colour space of COLOR_0 in a foreign glTF. The specification requires linear values, but
/// common Python tools write display-referred ones. `automatic` decides by the file's generator and
/// adds a remark.
enum class VertexColorSpace { automatic, srgb, linear };

class EarlyTexels;  // formats/tureen_glb/early_texels.hpp

struct ReadOptions {
  VertexColorSpace vertex_colors = VertexColorSpace::automatic;
  /// Q > 0 of octagon meshes (formats/splat/octagon_npz.hpp). nullopt: 4, with a remark.
  std::optional<double> octagon_q = {};
  /// Level of detail of a streamed SOG, 0 is the finest (formats/sog/sog.hpp). nullopt: the finest
  /// that fits, with a remark.
  std::optional<std::size_t> lod = {};
  /// Maximum number of splats, at least 1. The reader keeps those that contribute the most
  /// (scene/edit/splat_limit.hpp), with a remark. Readers of splat files hold an eighth more while
  /// they read, that of our GLB all shapes, but only the kept colours, others everything.
  std::optional<std::uint64_t> max_splats = {};
  /// Whether readers that reorder or drop splats fill Splats::rows. Not for our GLB, which keeps
  /// the order.
  bool keep_rows = false;
  /// Called with the number of splats in the file and their bytes in memory, before that memory is
  /// taken; may throw to stop. Not for triangle windows and foreign glTF.
  std::function<void(std::uint64_t splats, std::uint64_t bytes)> found_splats = {};
  /// Texels of this file that are decoded already, or null. The reader takes them if they fit.
  EarlyTexels* early_texels = nullptr;
  /// Called with the fraction done, 0..1; may throw to cancel.
  std::function<void(double)> progress = {};
};

}  // namespace tureen
