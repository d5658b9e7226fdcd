// Densification of triangle windows (trainer/splats/splat_densify.hpp): triangles are divided at
// the middle of their longest edge.
#pragma once

#include "trainer/splats/splat_densify.hpp"
#include "trainer/splats/windows/window_parameters.hpp"

namespace tureen::trainer {

/// The weight of a window in the choice of those to divide.
enum class WindowSampling {
  motion,  // splat_statistic::motion
  opacity,
  inverse_sigma,  // 1 / sigma
  alternating     // opacity and 1 / sigma in turn, as Triangle Splatting
};

/// In the order of the enumerators.
inline constexpr const char* window_sampling_words[] = {"motion", "opacity", "inverse_sigma",
                                                        "alternating"};

struct WindowDensifyOptions {
  std::size_t max_splats;
  double growth = 0.15;        // DensifyLimits
  float min_opacity = 0.014f;  // below: dead; as in the code of Triangle Splatting
  WindowSampling sampling = WindowSampling::motion;  // alternating: opacity
};

/// densify_splats() by WindowDensifyOptions::sampling.
DensifyReport densify_windows(const WindowDensifyOptions& options, Random& random,
                              WindowParameters& parameters, SplatMemory& memory);

}  // namespace tureen::trainer
