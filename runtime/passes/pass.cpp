#include "runtime/passes/pass.hpp"

#include <cmath>
#include <glm/matrix.hpp>

namespace tureen {

FrameCamera camera_in_layer(const Camera& camera, const glm::dmat4& world_from_layer,
                            const ClipRange& range) {
  const glm::dvec3 origin(world_from_layer[3]);
  FrameCamera result{.camera = camera, .eye = camera.eye() - origin, .range = range};
  const glm::dmat3 linear(world_from_layer);
  if (linear == glm::dmat3(1.0)) return result;  // no rounding at all
  result.scale = std::cbrt(std::abs(glm::determinant(linear)));
  result.world_from_layer = linear / result.scale;
  result.camera.view_from_world =
      glm::dmat4(glm::dmat3(camera.view_from_world) * result.world_from_layer);
  result.eye = glm::transpose(result.world_from_layer) * result.eye / result.scale;
  result.range = {range.near / result.scale, range.far / result.scale};
  return result;
}

}  // namespace tureen
