// All constants of the training of neural densities, with the table that reads, writes, checks and
// documents them.
#pragma once

#include <optional>
#include <string>

#include "trainer/splats/splat_config.hpp"

namespace tureen::trainer {

struct NeuralConfig : SplatConfig {
  using Field = BasicConfigField<NeuralConfig, Initialisation>;

  /// first_opacity is that of a round density through its centre: an offset of 1.
  NeuralConfig() {
    steps = 10000;
    max_splats = 10000;
    first_splats = 4000;
    first_opacity = 0.865f;
    degree_steps = 0;
    densify_until = 0.6;
    half_size_until = 0;
  }

  /// Steps of the Gaussians that are trained first, and the largest part of `minutes` for them.
  int gaussian_steps = 4000;
  double gaussian_share = 0.2;
  /// Semi-axes have at least and at most this length, relative to the region's half side.
  float min_axis = 1e-3f, max_axis = 2;
  /// Width of the part of a pixel, in pixels, in which a step draws the point of its rays.
  double jitter = 0;
  /// Of the mean standard deviation of the semi-axes over the smallest.
  float anisotropy_weight = 1e-3f;
};

template <>
std::span<const NeuralConfig::Field> splat_config_fields<NeuralConfig>();
std::optional<std::string> own_defect(const NeuralConfig& config);

}  // namespace tureen::trainer
