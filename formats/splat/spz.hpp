// SPZ files (nianticlabs/spz): versions 1 to 4 read, 3 and 4 written.
//
// Versions 1 to 3 are one gzip file: a header of 16 bytes, the arrays, extensions. Version 4 is not
// compressed as a whole: a header of 32 bytes, extensions, a table, and one ZSTD stream for each
// array that is not empty. Numbers are little endian.
//   header      u32 "NGSP", version, number of splats; u8 degree of harmonics (0..4), fractional
//               bits, flags (1: antialiased, 2: extensions), and in version 4 number of streams;
//               version 4: u32 place of the table, 12 bytes
//   table       for each stream u64 size in the file, and size of the array
//   extension   u32 type, u32 size, content
// The arrays, each of all splats:
//   positions   three signed fixed-point numbers of 24 bits; version 1: three half floats
//   alphas      u8: opacity is a 255th
//   colors      three u8: f_dc = (b / 255 - 1/2) / 0.15
//   scales      three u8: standard deviation exp(b / 16 - 10)
//   rotations   versions 1 and 2: u8 x, y, z as b / 127.5 - 1, and w >= 0. Later: u32, from the
//               highest bits on the index of the largest part of (x, y, z, w), which is positive,
//               then for each other part its sign and 9 bits, in units of sqrt(1/2) / 511
//   harmonics   u8 [coefficient][rgb] from degree 1 on: (b - 128) / 128
// The axes are right, up, back; they are read as right, down, front, those of splat PLY.
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

/// Whether the file begins with "NGSP", as it is or after decompression by gzip.
bool is_spz(std::span<const std::byte> head);

/// Gaussians with the profile 3dgs, or mip if antialiased. Adds a remark for extensions that do not
/// change the splats. Throws InputError for other versions, damaged data, a number of splats that a
/// file of this size cannot hold, and extensions that change axes or values.
Scene read_spz(Input& input, const ReadOptions& options = {});
Scene read_spz(const std::filesystem::path& path, const ReadOptions& options = {});

/// Writes Gaussians as `version` 3 or 4, quantised as Niantic's program does: harmonics have 5 bits
/// for degree 1 and 4 bits for higher ones. Centres have the 12 fractional bits of that program,
/// more where the scene would have less than 16 bits across, fewer where it would not fit. Returns
/// one sentence for each loss. Throws UsageError for other scenes, OutputError.
std::vector<std::string> write_spz(const Scene& scene, const std::filesystem::path& path,
                                   int version = 4);

}  // namespace tureen
