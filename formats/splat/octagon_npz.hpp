// Octagon meshes of REdiSplats (arXiv 2503.12284), read and written: the .npz archives of
// generate_mesh.py, also after an edit of their vertices.
//   vertices       [8 n, 3]  corner k of disc i in row 8 i + k
//   faces          [6 n, 3]  the fans (8 i, 8 i + k, 8 i + k + 1), k = 1..6
//   vertex_colors  [8 n, 4]  1/2 + Y_00 f_dc in 0..1, and opacity; constant on each octagon
// Corner k = m + sqrt(Q) (s_2 r_2 cos(k pi / 4) + s_3 r_3 sin(k pi / 4)), where m is the centre,
// r_2 and r_3 the axes of the disc and s_2 and s_3 its standard deviations. The file does not store
// Q. As in convert.py, the corners 0, 2 and 6 give the disc. Unlike there, a sheared octagon keeps
// its shape: the image of a disc under an affine map is a disc with other axes.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "base/input.hpp"
#include "formats/read_options.hpp"
#include "scene/scene.hpp"

namespace tureen {

/// Whether the file begins as a zip archive of .npy files.
bool is_octagon_npz(std::span<const std::byte> head);

/// Flat Gaussians of degree 0 with the profile redisplats. Drops octagons without an area or with
/// invalid values (splat_values.hpp). Adds a remark if `options` has no Q. Throws InputError if an
/// array is missing, damaged or of another shape, if the faces are no such fans, or if a colour
/// changes within an octagon.
Scene read_octagon_npz(Input input, const ReadOptions& options = {});
Scene read_octagon_npz(const std::filesystem::path& path, const ReadOptions& options = {});

/// Writes discs with Q = 4 and their colours of degree 0. Returns one sentence for each loss.
/// Throws UsageError for other scenes, OutputError.
std::vector<std::string> write_octagon_npz(const Scene& scene, const std::filesystem::path& path);

}  // namespace tureen
