// Fewer splats, where the memory does not hold all.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "scene/scene.hpp"

namespace tureen {

/// An estimate of each splat's contribution to images: its opacity times its largest cross-section,
/// up to a factor that all splats of a kernel share; 0 if that is not a number. In layer units
/// squared.
std::vector<double> splat_contributions(const SplatKernel& kernel);

/// The entries for keep_splats() that keep the `max` splats with the largest contributions, or all.
std::vector<std::uint8_t> largest_splats(const SplatKernel& kernel, std::size_t max);

/// The `max` splats that contribute the most, in their order; all if there are no more.
Splats largest_splats(Splats splats, std::size_t max);

/// Bytes that largest_splats() needs for a splat, while it runs.
inline constexpr std::size_t limit_bytes_per_splat =
    sizeof(double) + sizeof(std::uint32_t) + sizeof(std::uint8_t);

/// The number of a layer's `splats` that stay if `max` of `all` splats stay, `before` of them in
/// earlier layers: the same fraction of each layer, but at least one of each.
std::size_t share_of(std::uint64_t splats, std::uint64_t before, std::uint64_t max,
                     std::uint64_t all);

/// Keeps `max` splats of all layers together, by share_of(). Adds a remark if any are removed.
void limit_splats(Scene& scene, std::uint64_t max);

}  // namespace tureen
