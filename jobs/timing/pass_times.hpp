// The times of a frame's passes on the device's clock, with a check of that clock against the wall
// clock of the same frames.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "jobs/timing/pass_times_gap.hpp"
#include "runtime/gl/context.hpp"
#include "runtime/renderer.hpp"

namespace tureen {

struct PassTimes {
  /// (pass, milliseconds a frame) in frame order; empty if the device's clock is unusable.
  std::vector<std::pair<std::string, double>> ms;
  PassTimesGap gap = PassTimesGap::none;
  std::string reason;            // the gap as a sentence; empty without one
  std::optional<double> gpu_ms;  // all passes of a frame
};

/// The passes unchanged, or an empty result with a gap if their sum is 0 or exceeds `wall_ms`,
/// the mean time of such a frame without others in flight. A smaller sum is valid, since the frame
/// may wait for the processor. Below half of `wall_ms` the gap is `partial`.
PassTimes believed(std::vector<std::pair<std::string, double>> passes, double wall_ms);

/// Draws every camera `repeats` times with timers and as often without, for the wall clock of the
/// check. If timers mislead (gl::timers_mislead), returns the reason and draws nothing. The last
/// frame shows the last camera.
PassTimes time_passes(const gl::Context& context, Renderer& renderer,
                      std::span<const Camera> cameras, int repeats);

}  // namespace tureen
