#include "trainer/splats/neural/neural_config.hpp"

#include "trainer/splats/splat_config_table.hpp"

namespace tureen::trainer {

template <>
std::span<const NeuralConfig::Field> splat_config_fields<NeuralConfig>() {
  using namespace splat_range;
  static constexpr Range of_gaussians{0, 1e6, {}, "it is a part of the run"};
  static const std::vector<NeuralConfig::Field> fields = with_common_fields<NeuralConfig>({
      {"gaussian_steps", &NeuralConfig::gaussian_steps, of_gaussians,
       "Largest number of steps of a training of Gaussians, from which the densities begin; 0 for "
       "none"},
      {"gaussian_share", &NeuralConfig::gaussian_share, fraction,
       "Largest fraction of minutes for these Gaussians"},
      {"min_axis", &NeuralConfig::min_axis, length,
       "Smallest semi-axis, relative to the half side of the region of interest"},
      {"max_axis", &NeuralConfig::max_axis, length, "Largest semi-axis, in the same unit"},
      {"jitter", &NeuralConfig::jitter, fraction,
       "Width of the part of each pixel, in pixels, through which rays pass at random"},
      {"anisotropy_weight", &NeuralConfig::anisotropy_weight, weight,
       "Weight of the mean standard deviation of the semi-axes of a splat, over the smallest"},
  });
  return fields;
}

std::optional<std::string> own_defect(const NeuralConfig& config) {
  if (!(config.min_axis < config.max_axis))
    return "min_axis: " + float_text(config.min_axis) + " is not below max_axis, " +
           float_text(config.max_axis);
  return std::nullopt;
}

}  // namespace tureen::trainer
