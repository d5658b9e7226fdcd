// How a frame's time divides among its passes, by the device's clock, and whether that clock is to
// be believed: it is held against the wall clock of the same frames.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "runtime/gl/context.hpp"
#include "runtime/renderer.hpp"

namespace tureen {

struct PassTimes {
  /// (pass, milliseconds a frame) in the order of the frame; empty where the device's clock does
  /// not count.
  std::vector<std::pair<std::string, double>> ms;
  /// Why there are none, or what is to be said beside them, a sentence; empty where they are all.
  std::string reason;
  std::optional<double> gpu_ms;  // all passes of a frame together
};

/// The passes as they are, or a refusal where their sum is nothing, or more than `wall_ms`, the
/// mean time of such a frame with nothing else in flight, can hold. Less than that is no
/// contradiction, the frame may wait for the processor; but where it is less than half, the reason
/// says so.
PassTimes believed(std::vector<std::pair<std::string, double>> passes, double wall_ms);

/// Draws every camera `repeats` times with timers and once more as often without, for the wall
/// clock that they are held against. Says why where timers mislead (gl::timers_mislead) and draws
/// nothing then. The last frame shows the last camera.
PassTimes time_passes(const gl::Context& context, Renderer& renderer,
                      std::span<const Camera> cameras, int repeats);

}  // namespace tureen
