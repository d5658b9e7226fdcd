// A preview of a partially loaded file, for a first image while the rest arrives. No state is kept
// between calls: call for the size until it is known, and for the scene once as many bytes are
// available. formats/tureen_glb/tureen_glb_preview.hpp describes ours. Splats that are stored one
// after the other have previews of 16,384 splats, then twice as many as before: binary PLY of
// splats and .splat. Not supported: compressed PLY, whose harmonics follow all splats, and SPZ,
// where each value of all splats precedes the next value.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "formats/common/preview_size.hpp"
#include "scene/scene.hpp"

namespace tureen {

/// The size of the next preview, after one of `shown` bytes (0: none yet). Returns nullopt until
/// `prefix`, the available first bytes, determines it. Errors print `name` as the file. Throws
/// InputError. Safe for untrusted bytes.
std::optional<PreviewSize> preview_size(std::span<const std::byte> prefix, const std::string& name,
                                        std::uint64_t shown);

/// The previewed scene, without defect(). Returns nullopt if there is none. Throws InputError.
std::optional<Scene> read_preview(std::span<const std::byte> prefix, const std::string& name);

}  // namespace tureen
