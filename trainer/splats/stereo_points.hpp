// Points on surfaces, found in photographs with cameras: for datasets without points from structure
// from motion.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "scene/photographs.hpp"
#include "scene/region.hpp"

namespace tureen::trainer {

/// At most `count` points in world coordinates, with the colours of the photographs over
/// `background` (red, green, blue in [0, 1]). Each is the depth of a random pixel at which the
/// photographs of neighbouring cameras agree best: a sweep of planes (Collins 1996) that compares
/// patches by zero-mean normalised cross-correlation. Pixels without texture, and those at which
/// the photographs do not agree, give no point. Empty for fewer than three photographs; of more
/// than 300, every second, third and so on is used.
///
/// The result has the same bits with any number of threads; `threads`: 0 for all cores. `progress`:
/// receives the fraction of the points found; may be empty, and may throw.
std::vector<DatasetPoint> stereo_points(std::span<const Photograph> photographs,
                                        const Region& region, std::span<const float, 3> background,
                                        std::size_t count, std::uint64_t seed, int threads,
                                        const std::function<void(double fraction)>& progress = {});

}  // namespace tureen::trainer
