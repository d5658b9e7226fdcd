#include "scene/quality.hpp"

#include "base/decimal_text.hpp"

namespace tureen {

std::string describe(const Quality& quality) {
  if (quality.resolution_scale != 1)
    return short_decimal(100 * quality.resolution_scale, 4) + " % of the rows and columns";
  const std::string n = std::to_string(quality.supersampling);
  return quality.supersampling > 1 ? n + " x " + n + " samples a pixel" : "one sample a pixel";
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
  return std::nullopt;
}

}  // namespace tureen
