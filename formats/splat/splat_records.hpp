// .splat files (antimatter15/splat), read and written: records of 32 bytes, little endian, without
// a header.
//   bytes 0..11   centre: three floats
//   12..23        standard deviations: three floats
//   24..27        red, green, blue (1/2 + Y_00 f_dc) and opacity; a byte is a 255th
//   28..31        quaternion (w, x, y, z); a byte b is b / 127.5 - 1
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

inline constexpr std::size_t splat_record_size = 32;

/// Whether the path is a file whose size is a multiple of 32, and not 0, and either has the
/// extension .splat, or all records in its `head`, the first bytes, have the values of splats. The
/// content has no signature: other formats are recognised first.
bool is_splat_records(const std::filesystem::path& path, std::span<const std::byte> head);

/// Gaussians of degree 0 with the profile 3dgs. Throws InputError if the size is not a multiple of
/// 32.
Scene read_splat_records(Input& input, const ReadOptions& options = {});
Scene read_splat_records(const std::filesystem::path& path, const ReadOptions& options = {});

/// The colours of degree 0; the splats that contribute the most come first, since viewers draw what
/// has arrived. Returns one sentence for each loss. Throws UsageError for other scenes than
/// Gaussians, OutputError.
std::vector<std::string> write_splat_records(const Scene& scene, const std::filesystem::path& path);

}  // namespace tureen
