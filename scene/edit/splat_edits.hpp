// Changes to a scene of splats that make it cheaper to draw. `tureen tradeoff` measures their
// error.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "scene/scene.hpp"
#include "scene/splats.hpp"

namespace tureen {

/// Removes the splats with an entry of 0 in `keeps`, which has one a splat.
void keep_splats(SplatKernel& kernel, std::span<const std::uint8_t> keeps);

/// The splats with a nonzero entry in `keeps` (one a splat), with their colours, in their order.
Splats keep_splats(Splats splats, std::span<const std::uint8_t> keeps);

/// The windows of which an opaque triangle differs little: over their triangle, the mean of alpha
/// (mean_coverage()) is at least 0.9. One entry a splat; all 0 for other kernels.
std::vector<std::uint8_t> nearly_opaque_windows(const Splats& splats);

/// The default changes nothing.
struct SplatEdits {
  /// One entry a splat: 0 removes it. Empty: all stay. At least one stays.
  std::vector<std::uint8_t> keeps_splat = {};
  /// Whether nearly opaque windows become opaque triangles, in a layer of their own.
  bool opaque_windows = false;

  bool operator==(const SplatEdits&) const = default;
};

/// "30 of 60 splats, nearly opaque windows as triangles"; "none".
std::string describe(const SplatEdits& edits);

/// The scene, whose only layer has splats, with the edits applied.
Scene edited(Scene scene, const SplatEdits& edits);

}  // namespace tureen
