// Splats of tests of numerics, drawn by the renderer in tiles on the processor.
#pragma once

#include <vector>

#include "tests/numerics/splat_scenes.hpp"

namespace tureen::test {

/// As blended_by_device(), in tiles.
inline std::vector<glm::vec4> blended_by_tiles(const Scene& scene, const Camera& camera) {
  return blended_by_device(scene, camera, {.plan = {.splat_blending = SplatBlending::tiles}});
}

/// The largest difference of alpha, of the device and of the tiles, from these.
inline double alpha_error_of_both(const Scene& scene, const Camera& camera,
                                  const std::vector<double>& expected) {
  double error = alpha_error(scene, camera, expected);
  const std::vector<glm::vec4> blended = blended_by_tiles(scene, camera);
  for (std::size_t i = 0; i < blended.size(); ++i)
    error = worse(error, std::abs(double(blended[i].a) - expected[i]));
  return error;
}

}  // namespace tureen::test
