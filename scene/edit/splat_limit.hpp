// Fewer splats, where the memory does not hold all.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "scene/scene.hpp"

namespace tureen {

/// How much each splat contributes to images, without a view: its opacity times its largest
/// cross-section, up to a factor that all splats of a kernel share. One entry a splat, in layer
/// units squared.
std::vector<float> splat_contributions(const Splats& splats);

/// The `max` splats that contribute the most, in their order; all if there are no more.
Splats largest_splats(Splats splats, std::size_t max);

/// Keeps at most `max` splats of all layers together, the same fraction of each layer but at least
/// one splat. Adds a remark if any are removed.
void limit_splats(Scene& scene, std::uint64_t max);

}  // namespace tureen
