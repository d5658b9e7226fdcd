// All constants of the training of triangle windows, with the table that reads, writes, checks and
// documents them.
#pragma once

#include <optional>
#include <string>

#include "trainer/splats/splat_config.hpp"
#include "trainer/splats/windows/window_densify.hpp"

namespace tureen::trainer {

struct WindowConfig : SplatConfig {
  using Field = BasicConfigField<WindowConfig, Initialisation, WindowSampling>;

  /// first_opacity and first_sigma are those of Triangle Splatting (arXiv 2505.19175).
  WindowConfig() {
    first_splats = 30000;
    first_opacity = 0.28f;
    densify_every = 100;
    growth = 0.15;
    half_size_until = 0;
  }

  /// Circumradius of the first triangles: at random places relative to the mean spacing, at points
  /// relative to twice the distance to the nearest other point.
  float first_size = 0.4f;
  float first_sigma = 1.16f;
  WindowSampling sampling = WindowSampling::motion;
  float opacity_weight = 0.0055f;  // of the mean opacity
  float size_weight = 1e-8f;       // of the mean of 1 / area, in 1 / (layer unit)^2
  double size_until = 0.83;        // fraction of the steps; 25,000 of 30,000
  /// The windows become opaque triangles between opaque_from and opaque_until, fractions of the
  /// steps. With photographs of lego at 400x400 that were held back from training, opaque_until
  /// 0.6, 0.7, 0.8 and 0.9 give 29.9, 30.4, 30.7 and 30.9 dB with 4x4 samples.
  bool opaque = false;
  double opaque_from = 0.5, opaque_until = 0.9;
  /// From this fraction of the steps on, windows below this opacity are dead; later the solidity
  /// is above it.
  double prune_from = 0.4;
  float min_opacity_before_opaque = 0.2f;
  /// Of VarianceLoss, times the solidity. With photographs of lego at 200x200 that were held back
  /// from training, 0, 1, 3 and 6 give 24.8, 25.0, 25.4 and 25.3 dB with one sample per pixel, and
  /// 27.9, 27.9, 27.8 and 27.3 dB with 4x4.
  float variance_weight = 3;
};

template <>
std::span<const WindowConfig::Field> splat_config_fields<WindowConfig>();
std::optional<std::string> own_defect(const WindowConfig& config);

}  // namespace tureen::trainer
