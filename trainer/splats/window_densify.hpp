// Densification of triangle windows: those that no image needs take the places of halves of others,
// and their number grows.
#pragma once

#include <cstddef>

#include "trainer/common/random.hpp"
#include "trainer/splats/splat_memory.hpp"
#include "trainer/splats/window_parameters.hpp"

namespace tureen::trainer {

/// The weight of a window in the choice of those to split.
enum class WindowSampling {
  motion,         // splat_statistic::motion
  opacity,        // Triangle Splatting alternates between opacity
  inverse_sigma,  // and 1 / sigma
};

struct WindowDensifyOptions {
  std::size_t max_splats;
  double growth = 0.15;        // largest, a fraction of the number of windows
  float min_opacity = 0.014f;  // below: dead; as in the code of Triangle Splatting
  float overlap = 0.1f;        // of the halves, a fraction of the divided edge at each side
  WindowSampling sampling = WindowSampling::motion;
};

struct WindowDensifyReport {
  std::size_t dead = 0;   // of them, as many are relocated as there are parents
  std::size_t split = 0;  // divided into two
};

/// A window is dead if it was not evident in any step since the last call, or its opacity is low,
/// or it is not finite. Parents are drawn without replacement from the others. Each is divided at
/// the middle of its longest edge; one half takes its place, the other one that of a dead window or
/// a new one. The moments of halves begin at 0, and so do all statistics except the steps of other
/// windows. If all are dead, or none has a weight, nothing changes.
WindowDensifyReport densify_windows(const WindowDensifyOptions& options, Random& random,
                                    WindowParameters& parameters, SplatMemory& memory);

}  // namespace tureen::trainer
