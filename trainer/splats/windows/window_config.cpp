#include "trainer/splats/windows/window_config.hpp"

#include "trainer/splats/splat_config_table.hpp"
#include "trainer/splats/windows/window_parameters.hpp"

namespace tureen::trainer {

template <>
std::span<const WindowConfig::Field> splat_config_fields<WindowConfig>() {
  using namespace splat_range;
  // log_of_sigma() is finite, and at most max_log_sigma.
  static constexpr Range sigma{0.0101, 20, {}, "other values are outside of the trained range"};
  static const std::vector<WindowConfig::Field> fields = with_common_fields<WindowConfig>({
      {"first_size", &WindowConfig::first_size, length,
       "Circumradius of the initial triangles: relative to the mean spacing, or at points to twice "
       "the distance to the nearest other point"},
      {"first_sigma", &WindowConfig::first_sigma, sigma, "Sigma of the initial triangles"},
      {"sampling", &WindowConfig::sampling, none,
       "Weight in the choice of triangles to divide; alternating is opacity and 1 / sigma in turn, "
       "as Triangle Splatting",
       window_sampling_words},
      {"opacity_weight", &WindowConfig::opacity_weight, weight, "Weight of the mean opacity"},
      {"size_weight", &WindowConfig::size_weight, weight,
       "Weight of the mean of 1 / area, in 1 / (unit of the scene)^2"},
      {"size_until", &WindowConfig::size_until, fraction,
       "Fraction of the steps after which size_weight is 0"},
      {"opaque", &WindowConfig::opaque, none,
       "Whether the triangles become opaque, and the result is a triangle soup"},
      {"opaque_from", &WindowConfig::opaque_from, fraction,
       "Fraction of the steps at which triangles begin to become opaque"},
      {"opaque_until", &WindowConfig::opaque_until, fraction,
       "Fraction of the steps at which all triangles are opaque"},
      {"prune_from", &WindowConfig::prune_from, fraction,
       "If opaque: fraction of the steps from which on triangles of low opacity are replaced"},
      {"min_opacity_before_opaque", &WindowConfig::min_opacity_before_opaque, fraction,
       "If opaque: the opacity below which they are replaced"},
      {"variance_weight", &WindowConfig::variance_weight, weight,
       "If opaque: weight of the variance of the samples in a pixel, for sharp images with one "
       "sample per pixel"},
  });
  return fields;
}

std::optional<std::string> own_defect(const WindowConfig& config) {
  if (config.opaque && !(config.opaque_from < config.opaque_until))
    return "opaque_from: " + double_text(config.opaque_from) + " is not below opaque_until, " +
           double_text(config.opaque_until);
  return std::nullopt;
}

}  // namespace tureen::trainer
