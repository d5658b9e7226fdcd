#include "scene/quality.hpp"

#include <cstddef>

#include "base/decimal_text.hpp"

namespace tureen {

const char* name_of(Quality::SplatOrder order) { return splat_order_names[std::size_t(order)]; }

bool has_one_sample_a_pixel(const Quality& quality) {
  return quality.resolution_scale == 1 && quality.supersampling == 1;
}

std::string describe(const Quality& quality) {
  std::string text;
  if (quality.resolution_scale != 1) {
    text = short_decimal(100 * quality.resolution_scale, 4) + " % of the rows and columns";
  } else if (quality.supersampling > 1) {
    const std::string n = std::to_string(quality.supersampling);
    text = n + " x " + n + " samples per pixel";
  }
  const auto add = [&](const char* words) {
    text += (text.empty() ? "" : ", ") + std::string(words);
  };
  if (quality.splat_order == Quality::SplatOrder::exact) add("splats in exact order");
  if (quality.splat_order == Quality::SplatOrder::stochastic) add("stochastic splats");
  return text.empty() ? "one sample per pixel" : text;
}

std::optional<std::string> defect(const Quality& quality) {
  // Negated, so that NaN is rejected too.
  if (!(quality.resolution_scale >= 0.25 && quality.resolution_scale <= 1))
    return "the resolution scale is " + short_decimal(quality.resolution_scale, 4) +
           ", not 0.25 to 1";
  if (quality.supersampling < 1 || quality.supersampling > 8)
    return "supersampling is " + std::to_string(quality.supersampling) + ", not 1 to 8";
  if (quality.resolution_scale < 1 && quality.supersampling > 1)
    return "a resolution scale below 1 and supersampling cannot be combined";
  if (quality.splat_order < Quality::SplatOrder::center ||
      quality.splat_order > Quality::SplatOrder::stochastic)
    return "the splat order is neither centre, exact nor stochastic";
  return std::nullopt;
}

}  // namespace tureen
