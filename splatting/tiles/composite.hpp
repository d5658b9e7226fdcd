// Blended splats over a plain background, in bytes.
#pragma once

#include <cstdint>
#include <glm/vec4.hpp>
#include <span>

namespace tureen::splatting {

/// Writes a pixel of `colors` (RGBA, the lowest byte is red) for each premultiplied RGBA in `rgba`.
/// Results and `background` are not premultiplied. As shaders/splats/splat_resolve.frag.
void composite(std::span<const float> rgba, const glm::vec4& background,
               std::span<std::uint32_t> colors);

}  // namespace tureen::splatting
