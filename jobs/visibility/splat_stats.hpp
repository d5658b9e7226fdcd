// Where a layer of splats spends memory and time: bytes by column, overdraw, splats without use.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "scene/camera.hpp"
#include "scene/scene.hpp"

namespace tureen {

struct ColumnBytes {
  std::string name;
  std::size_t bytes;
};

struct SplatStats {
  std::vector<ColumnBytes>
      columns;            // in the order of the kernel's file, then colours and harmonics
  std::size_t views = 0;  // 0: there are more splats than tiles can draw
  /// Splats blended per pixel with at least one splat, until it is saturated: mean over the pixels
  /// of all views, and of the view with the most.
  double mean_overdraw = 0, worst_overdraw = 0;
  std::string worst_view;         // its name, or "" if it has none
  std::uint64_t never_drawn = 0;  // splats that contribute less than a millionth of a pixel
};

/// Draws the layer alone from each view, at one thread. `progress` is called with the fraction
/// done, 0..1, and may throw.
SplatStats splat_stats(const Splats& splats, const glm::dmat4& world_from_layer,
                       std::span<const Camera> views,
                       const std::function<void(double)>& progress = {});

}  // namespace tureen
