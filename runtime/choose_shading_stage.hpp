// Whether the shading pass is faster as a fragment or as a compute shader, by measurement: the two
// take turns on the same frame, each turn from an idle device until it has finished. Rasterisers
// of datacenter GPUs feed only some of the cores that compute shaders have; elsewhere the depth
// test rejects the background for nothing.
#pragma once

#include <functional>
#include <string>

#include "runtime/plan.hpp"

namespace tureen {

struct StageTiming {
  /// Draws the shading pass of one frame in `fragment` or `compute`; may return before the device
  /// has finished. Pixels are the same however often it is called.
  std::function<void(ShadingStage)> shade;
  std::function<void()> finish;             // waits for the device
  std::function<double()> clock = nullptr;  // seconds; the steady clock when empty
};

struct StageChoice {
  ShadingStage stage = ShadingStage::fragment;
  double fragment_ms = 0, compute_ms = 0;  // medians of a pass
  /// Between the second fastest and the second slowest turn, of whichever varies more.
  double spread_ms = 0;

  bool operator==(const StageChoice&) const = default;
};

/// The compute stage where it is faster by more than the spread, else the fragment stage. A warm-up
/// of each, then seven turns of each; a turn is so many passes that the fragment stage's take about
/// two milliseconds, 32 at most.
StageChoice choose_shading_stage(const StageTiming& timing);

/// "shading runs as compute: 0.42 ms against 0.61 ms in the fragment stage, spread 0.01 ms".
std::string sentence_of(const StageChoice& choice);

}  // namespace tureen
