// The specialisations of a plan in JSON, beside the plan's English.
#pragma once

#include <span>

#include "cli/report.hpp"
#include "runtime/specialisation.hpp"

namespace tureen::cli {

/// [{"name": "alpha-test", "count": 7, "total": 9, "margin": 0}, ..]: "margin" in steps of 8 bits,
/// "count" of "total" faces, bands or neurons, or 0 of 0.
Json specialisations_json(std::span<const AppliedSpecialisation> specialisations);

}  // namespace tureen::cli
