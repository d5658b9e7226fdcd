// Compressed PLY of PlayCanvas (splat-transform, SuperSplat; usually named .compressed.ply), read
// and written.
//
// element chunk: the ranges of 256 consecutive splats:
//   min_x .. max_z               centres
//   min_scale_x .. max_scale_z   logarithms of the standard deviations
//   min_r .. max_b               1/2 + Y_00 f_dc; without them 0 and 1
// element vertex: four uint, each with fractions of these ranges from the highest bits on:
//   packed_position  11 bits x, 10 y, 11 z
//   packed_scale     the same
//   packed_color     8 bits each: red, green, blue, opacity in 0..1
//   packed_rotation  2 bits: index of the largest part of (w, x, y, z), which is positive; 10 bits
//                    for each other part, in -sqrt(1/2)..sqrt(1/2)
// element sh, optional: f_rest_0.. as uchar, in the order of 3DGS, -4..4
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/input.hpp"
#include "formats/ply/ply_header.hpp"
#include "formats/read_options.hpp"
#include "scene/scene.hpp"

namespace tureen {

/// Whether the vertices have packed_position and an element 'chunk' exists.
bool is_compressed_ply(const PlyHeader& header);

/// Comments select the profile as in splat_ply.hpp. Throws InputError with the line (header and
/// ascii) or the byte.
Scene read_compressed_ply(Input& input, const PlyHeader& header, const ReadOptions& options);

/// Gaussians and discs, in Morton order. Returns one sentence for each loss. Throws UsageError for
/// other scenes, OutputError.
std::vector<std::string> write_compressed_ply(const Scene& scene,
                                              const std::filesystem::path& path);

}  // namespace tureen
