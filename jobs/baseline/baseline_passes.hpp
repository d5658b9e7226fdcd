// The passes of the baselines (jobs/baseline/baseline.hpp).
#pragma once

#include "runtime/prepared_scene.hpp"

namespace tureen {

/// The soup must not move until the passes were made.
MakePasses baseline_passes(const TriangleSoup& soup, const DeviceLimits& limits);
/// Copies the splats.
MakePasses baseline_passes(const Splats& splats, const SplatPlan& plan, const DeviceLimits& limits);

}  // namespace tureen
