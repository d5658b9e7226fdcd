// The strips of a lattice texture's texels: their places in the file, and their images. The reader
// of whole files and EarlyTexels share it. Include it only in sources.
#pragma once

#include <vector>

#include "formats/glb/glb_arrays.hpp"
#include "formats/tureen_glb/early_texels.hpp"
#include "image/image.hpp"

namespace tureen {

/// The image's bytes.
FileRange image_range(const GlbArrays& arrays, const JsonView& reference);

/// Images must lie in the order of their references, without overlap. Otherwise a small file could
/// fill the memory with repeated references to the same bytes. `end`: of the image before; set to
/// the end of this one.
FileRange next_image_range(const GlbArrays& arrays, const JsonView& reference, std::uint64_t& end);

/// The strips of an appearance with "strips". Throws InputError if they are not contiguous, or have
/// more texels than their images can hold.
std::vector<TexelStrip> texel_strips(const GlbArrays& arrays, const JsonView& appearance,
                                     std::uint64_t& images_end);

/// Appends a texel for each pixel of `low`: its channels, and those of `high`.
void append_texels(std::span<const glm::u8vec4> low, std::span<const glm::u8vec4> high,
                   std::vector<std::uint8_t>& texels);

}  // namespace tureen
