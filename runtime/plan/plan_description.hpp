// A plan in English.
#pragma once

#include <string>
#include <vector>

#include "runtime/plan/plan.hpp"

namespace tureen {

/// The method of drawing, then one sentence for each quality setting, and one for each
/// specialisation with its count and margin; for each of several layers, counted from 1.
/// RenderPlan::description, if the plan has one.
std::vector<std::string> describe(const RenderPlan& plan);

/// A sentence on the resolution scale and one on the samples; none for one sample per pixel.
std::vector<std::string> describe_sampling(const Quality& quality);

/// "alpha-test: 7 of 9 faces are opaque throughout and need no alpha test (exact)".
std::string describe(const AppliedSpecialisation& specialisation);

}  // namespace tureen
