// The contribution of each splat to images.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/mat4x4.hpp>
#include <span>
#include <vector>

#include "scene/camera.hpp"
#include "scene/splats.hpp"

namespace tureen::tradeoff {

/// For each splat, the sum over all pixels of the views of alpha times the transmittance of the
/// splats in front, in millionths: its share of the images, whatever its colour. `world_from_layer`
/// as Layer has it. `progress` is called with the fraction done, 0..1, and may throw.
std::vector<std::uint64_t> splat_weights(const Splats& splats, const glm::dmat4& world_from_layer,
                                         std::span<const Camera> views,
                                         const std::function<void(double)>& progress = {});

}  // namespace tureen::tradeoff
