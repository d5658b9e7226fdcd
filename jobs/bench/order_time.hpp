// The time in which the processor orders the splats of a scene. Frames of a moving camera include
// it.
#pragma once

#include <functional>
#include <optional>
#include <span>

#include "jobs/baseline/baseline.hpp"
#include "scene/camera.hpp"
#include "scene/scene.hpp"

namespace tureen {

/// Milliseconds a view for sorting all splats, by SplatOrder (also for tiles, which sort the same
/// keys) or by the baseline's order: the mean over the cameras of the best of three times. Empty
/// without splats. `clock` is in seconds; null:
/// the steady clock. Asserts cameras.
std::optional<double> order_ms(const Scene& scene, PipelineKind pipeline,
                               std::span<const Camera> cameras,
                               const std::function<double()>& clock = nullptr);

}  // namespace tureen
