// Views on and around a scene, for measuring it.
#pragma once

#include <cstddef>
#include <vector>

#include "scene/camera.hpp"
#include "scene/scene.hpp"

namespace tureen {

/// `count` views of at most `side` pixels a side: up to half of them recorded cameras, spread
/// evenly; the others as hemisphere() (camera/camera_sets.hpp), every second one at a third of the
/// distance, where single splats are visible.
std::vector<Camera> survey_views(const Scene& scene, std::size_t count, int side);

}  // namespace tureen
