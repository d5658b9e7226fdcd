#include "trainer/splats/gaussians/gaussian_config.hpp"

#include "trainer/splats/splat_config_table.hpp"

namespace tureen::trainer {

template <>
std::span<const GaussianConfig::Field> splat_config_fields<GaussianConfig>() {
  static const std::vector<GaussianConfig::Field> fields = with_common_fields<GaussianConfig>({
      {"flat", &GaussianConfig::flat, ranges::none,
       "true: discs (2D Gaussian Splatting) instead of Gaussians with three scales"},
      {"min_scale", &GaussianConfig::min_scale, splat_range::length,
       "Smallest standard deviation of a splat, relative to the half side of the region of "
       "interest"},
      {"max_scale", &GaussianConfig::max_scale, splat_range::length,
       "Largest standard deviation of a splat, in the same unit"},
  });
  return fields;
}

std::optional<std::string> own_defect(const GaussianConfig& config) {
  if (!(config.min_scale < config.max_scale))
    return "min_scale: " + float_text(config.min_scale) + " is not below max_scale, " +
           float_text(config.max_scale);
  return std::nullopt;
}

}  // namespace tureen::trainer
