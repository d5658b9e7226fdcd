// SOG, "spatially ordered Gaussians" (PlayCanvas), read and written: splats as images of bytes in
// lossless WebP, beside a meta.json, in a folder or at the root of a zip archive (.sog). Read are
// the versions 1 and 2, written is version 2.
// https://developer.playcanvas.com/user-manual/gaussian-splatting/formats/sog/
//
// Splat i is pixel i of each image, row by row.
//   means_l, means_u  low and high byte of x, y, z: 16-bit fractions of the range of
//                     sign(x) log(1 + |x|)
//   quats             red, green, blue: the three smaller parts of (w, x, y, z), in
//                     -sqrt(1/2)..sqrt(1/2); alpha: 252 + index of the largest, which is positive
//   scales            index of a logarithm in a codebook of 256
//   sh0               red, green, blue: index of f_dc in a codebook of 256; alpha: opacity
//   shN_labels        red + 256 green: index of an entry of the palette
//   shN_centroids     the palette, 64 entries a row; each has 3, 8 or 15 pixels, one per
//   coefficient
//                     of degree 1 and up: index in a codebook of 256
// Version 1 has ranges in the place of codebooks, and opacity as logit. The axes are those of splat
// PLY.
//
// A streamed SOG (lod-meta.json) has SOGs at several levels of detail, and a tree of boxes whose
// leaves name a range of splats for each level. Level 0 is the finest.
// https://developer.playcanvas.com/user-manual/gaussian-splatting/formats/streamed-sog/
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "base/input.hpp"
#include "formats/read_options.hpp"
#include "scene/scene.hpp"

namespace tureen {

/// Whether the path is a folder with a meta.json or lod-meta.json, such a file (`head`: its first
/// bytes), or an archive that begins with an image or a JSON file.
bool is_sog(const std::filesystem::path& path, std::span<const std::byte> head);

/// Gaussians with the profile 3dgs, mip or 2dgs (flat). Of a streamed SOG one level: that of
/// ReadOptions::lod, or the finest that fits ReadOptions::max_splats and the budget, with a remark;
/// its environment is included. Throws InputError.
Scene read_sog(const std::filesystem::path& path, const ReadOptions& options = {});
Scene read_sog_archive(Input archive, const ReadOptions& options = {});

/// What read_sog() would read, for a caller that fetches files one after the other.
struct SogNeeds {
  std::vector<std::uint64_t> levels = {};  // splats by level of detail; empty if it has none
  std::size_t level = 0;  // ReadOptions::lod, or the finest with at most ReadOptions::max_splats
  /// Files of that level that do not exist, relative to the folder. Names that the reader rejects
  /// are not among them. Further ones may follow when these exist.
  std::vector<std::string> missing = {};
};
/// Throws InputError.
SogNeeds sog_needs(const std::filesystem::path& path, const ReadOptions& options = {});

/// Whether write_sog can store the scene: one layer with Gaussians.
bool fits_sog(const Scene& scene);

/// Version 2 in a zip archive. Splats in Morton order; codebooks and palette minimise the squared
/// error. Returns one sentence for each loss. Throws OutputError.
std::vector<std::string> write_sog(const Scene& scene, const std::filesystem::path& path);

}  // namespace tureen
