// Splats in PLY files, read and written: 3DGS (arXiv 2308.04079), 2DGS (arXiv 2403.17888), GaMeS
// (arXiv 2402.01459) and splattable neural primitives (arXiv 2510.08491).
//
// One element 'vertex', whose properties are found by name, in any order and type; the values are
// stored before activation:
//   x y z                       centre
//   f_dc_0..2                   harmonics of degree 0, RGB
//   f_rest_0..                  0, 9, 24, 45 or 72 of them: degrees 0 to 4; first all of red, then
//                               green, then blue
//   opacity                     logit; +-infinity is legal
//   scale_0..2                  logarithms of the standard deviations or semi-axes
//   rot_0..3                    quaternion (w, x, y, z) of any length but 0
//   frequencies_0..23           neural primitives: frequency of dimension k / 8 of neuron k % 8
//   phases_0..7, amplitudes_0..7, offsets
// Without scale_2 the Gaussians are flat. Other properties and elements are skipped.
//
// Comments select the profile; the last one counts:
//   comment SplatRenderMode: default | mip | 2dgs     (Brush)
//   comment antialiased 0 | 1                         (Postshot; default, mip)
//   comment TureenSplatProfile: redisplats            (ours; for flat Gaussians)
// 3D Gaussians with the mode 2dgs are read as flat ones, with their local z axis as the normal.
// For flat Gaussians the profile also selects the axes, since the file's layout does not show them.
// 2DGS: scale_0 and scale_1 belong to the local x and y axes. GaMeS and REdiSplats: to y and z, and
// x is the normal. Without a comment, 2DGS is assumed, with a remark; `default` and `mip` are
// GaMeS.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/input.hpp"
#include "formats/ply/ply_header.hpp"
#include "formats/read_options.hpp"
#include "scene/scene.hpp"

namespace tureen {

/// Whether the file holds splats: vertices with scale_0 and rot_0, and no faces.
bool is_splat_ply(const PlyHeader& header);

/// Throws InputError with the line (header and ascii) or the byte.
Scene read_splat_ply(Input& input, const PlyHeader& header, const ReadOptions& options);

/// Whether write_splat_ply can store the scene: one layer with Gaussians or neural densities.
bool fits_splat_ply(const Scene& scene);

/// Binary, little endian, with all properties that the authors' programs read: 3DGS with three
/// scales, flat Gaussians with two, neural densities with 104 floats (at least degree 3).
/// Positions, rotations of unit length, coefficients and networks read back bit for bit, as do
/// opacities and scales of 0 and opacities of 1. Other opacities and scales pass through a
/// logarithm in single precision: their relative error is at most 6e-8 |log(value)|. The rotations
/// of GaMeS files are turned between axes and rounded. Returns one sentence for each loss. Throws
/// OutputError.
std::vector<std::string> write_splat_ply(const Scene& scene, const std::filesystem::path& path);

}  // namespace tureen
