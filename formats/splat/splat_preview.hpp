// A preview of a partially loaded file whose splats are stored one after the other: its first
// splats. Supported: binary PLY of splats and .splat. Not supported: compressed PLY, whose
// harmonics follow all splats, and SPZ, where each value of all splats precedes the next value.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "formats/common/preview_size.hpp"
#include "scene/scene.hpp"

namespace tureen {

/// The size of the next preview, after one of `shown` bytes (0: none yet): 16,384 splats, then
/// twice as many as before. Returns nullopt until the header is complete. There is no (further)
/// preview for other formats, and for all splats. Errors print `name` as the file. Throws
/// InputError. Safe for untrusted bytes.
std::optional<PreviewSize> splat_preview_size(std::span<const std::byte> prefix,
                                              const std::string& name, std::uint64_t shown);

/// The splats that `prefix` holds, as the reader of the format returns them. Returns nullopt if
/// there are none. Throws InputError.
std::optional<Scene> read_splat_preview(std::span<const std::byte> prefix, const std::string& name);

}  // namespace tureen
