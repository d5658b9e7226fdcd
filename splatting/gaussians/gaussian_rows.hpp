// Gaussians, flat or not, as rows.
#pragma once

#include <cstdint>
#include <span>

#include "scene/splats.hpp"
#include "splatting/parameter_rows.hpp"

namespace tureen::splatting {

/// The rows of gaussian_row, for the splats with these indices and harmonics up to `degree`. The
/// third scale of flat Gaussians is 0.
ParameterRows rows_of(const Gaussians& gaussians, const SplatColor& color,
                      std::span<const std::uint32_t> which, int degree);

}  // namespace tureen::splatting
