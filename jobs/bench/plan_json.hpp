// The specialisations of a plan in JSON. Results also have the plan as English text.
#pragma once

#include <span>
#include <vector>

#include "base/json/json_text.hpp"
#include "base/json/json_view.hpp"
#include "runtime/plan/specialisation.hpp"

namespace tureen::results {

/// [{"name": "alpha-test", "count": 7, "total": 9, "margin": 0}, ..]: "margin" in steps of 8 bits,
/// "count" of "total" faces, bands or neurons, or 0 of 0.
Json specialisations_json(std::span<const AppliedSpecialisation> specialisations);

/// Reads such a list. Throws InputError.
std::vector<AppliedSpecialisation> specialisations_of(const JsonView& list);

}  // namespace tureen::results
