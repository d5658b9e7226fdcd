// .ksplat files (mkkellogg/GaussianSplats3D, version 0.1), read. Little endian.
//   header          4096 bytes: u8 major 0, u8 minor 1; at 4 u32 number of section headers; at 16
//                   u32 number of splats, u16 level of compression; at 36 two floats: range of the
//                   harmonics of level 2 (0: -1.5, 1.5)
//   section header  1024 bytes each: u32 splats, stored splats, splats and number of buckets; float
//                   side of a bucket's box; u16 bytes of a bucket; at 24 u32 steps in half of the
//                   box (0: 32767), at 32 u32 full buckets, partly filled ones, u16 degree 0..2
//   section         u32 size of each partly filled bucket; three floats for each bucket: its
//   centre;
//                   the splats
//   splat           centre, standard deviations, quaternion (w, x, y, z): floats; level 1 and 2:
//                   centre as u16 steps in the box, others as half floats. Red, green, blue
//                   (1/2 + Y_00 f_dc), opacity: a byte is a 255th. Harmonics by degree, then by
//                   channel: floats, half floats, or bytes as fractions of their range
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

#include "base/input.hpp"
#include "formats/read_options.hpp"
#include "scene/scene.hpp"

namespace tureen {

/// Whether the name ends in .ksplat: the content has no signature.
bool is_ksplat(const std::filesystem::path& path);

/// Gaussians with the profile 3dgs. Throws InputError for other versions and levels, and where
/// sections, buckets or splats do not lie within the file.
Scene read_ksplat(Input& input, const ReadOptions& options = {});
Scene read_ksplat(const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace tureen
