// All constants of the training of Gaussians, with the table that reads, writes, checks and
// documents them.
#pragma once

#include <optional>
#include <string>

#include "trainer/splats/splat_config.hpp"

namespace tureen::trainer {

struct GaussianConfig : SplatConfig {
  using Field = BasicConfigField<GaussianConfig, Initialisation>;

  /// Discs with two scales on their planes (2D Gaussian Splatting, arXiv 2403.17888), instead of
  /// Gaussians with three.
  bool flat = false;
  /// Scales have at least and at most this length, relative to the region's half side.
  float min_scale = 3e-4f, max_scale = 1;
};

template <>
std::span<const GaussianConfig::Field> splat_config_fields<GaussianConfig>();
std::optional<std::string> own_defect(const GaussianConfig& config);

}  // namespace tureen::trainer
