// The options of renderers in pages.
#pragma once

#include "runtime/render_options.hpp"
#include "scene/scene.hpp"

namespace tureen::web {

/// A page shares the device's memory with all other pages. Above this size, half the memory is more
/// important than an alpha test in two thirds of the time (docs/decisions/alpha-cells.md).
inline constexpr std::uint64_t max_alpha_cell_bytes = 16 << 20;

inline RenderOptions page_options(const Scene& scene, SplatBlending blending) {
  RenderOptions options;
  options.plan.splat_blending = blending;
  options.plan.max_alpha_cell_bytes = max_alpha_cell_bytes;
  options.plan.quality = scene.quality;
  return options;
}

}  // namespace tureen::web
