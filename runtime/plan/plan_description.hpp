// A plan in English.
#pragma once

#include <string>
#include <vector>

#include "runtime/plan/plan.hpp"

namespace tureen {

/// The method of drawing, then one sentence for each quality setting, and one for each
/// specialisation with its count and margin.
std::vector<std::string> describe(const RenderPlan& plan);

/// "alpha-test: 7 of 9 faces are opaque throughout and need no alpha test (exact)".
std::string describe(const AppliedSpecialisation& specialisation);

}  // namespace tureen
