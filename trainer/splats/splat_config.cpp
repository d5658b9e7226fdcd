#include "trainer/splats/splat_config.hpp"

namespace tureen::trainer {

std::optional<std::string> common_defect(const SplatConfig& config) {
  if (config.l1_weight == 0 && config.ssim_weight == 0)
    return "l1_weight: 0, and ssim_weight is 0 too (one of them must be above 0)";
  return std::nullopt;
}

}  // namespace tureen::trainer
