// What the splats of a layer contribute to images, and what they cost there.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/mat4x4.hpp>
#include <span>
#include <vector>

#include "scene/camera.hpp"
#include "scene/splats.hpp"
#include "splatting/tiles/tile_renderer.hpp"

namespace tureen {

struct SplatUse {
  /// For each splat, the sum over all pixels of the views of alpha times the transmittance of the
  /// splats in front, in millionths: its share of the images, whatever its colour.
  std::vector<std::uint64_t> weights;
  std::vector<splatting::TileRenderer::Overdraw> views;
};

/// Draws the layer alone from each view on the processor. `world_from_layer` as Layer has it; the
/// splats fulfil splatting::has_layer_for(). `progress` is called with the fraction done, 0..1, and
/// may throw.
SplatUse splat_use(const Splats& splats, const glm::dmat4& world_from_layer,
                   std::span<const Camera> views, const std::function<void(double)>& progress = {});

}  // namespace tureen
