// The near limit of splats (SplatProfile::min_center_depth), a rule of the published rasterisers in
// units of the layer: a scene in small units lies before it and is not drawn.
#pragma once

#include <cstddef>
#include <optional>

#include "scene/remark.hpp"
#include "scene/scene.hpp"

namespace tureen {

/// A near limit that suits the splats if theirs is above half the radius of middle_bounds(), so
/// that usual views lose splats: a tenth of the radius, in layer units. Otherwise nullopt. Usual
/// views are farther away than the radius; a tenth of it also permits nearer views. O(n).
std::optional<float> lower_near_limit(const Splats& splats);

struct HiddenSplats {
  std::size_t hidden = 0;   // centres before the near limit
  std::size_t in_view = 0;  // centres in front of the camera and in its image
};
/// What the near limit hides from a camera. O(n).
HiddenSplats hidden_by_near_limit(const Splats& splats, const glm::dmat4& world_from_layer,
                                  const Camera& camera);

/// A remark if the near limit of a visible layer hides over 1 % of the splats in the view of the
/// first recorded camera (fewer are strays at the eye, which the limit is for), or, in a scene
/// without cameras, if lower_near_limit() has a value. At most one, for the first such layer.
std::optional<Remark> near_limit_remark(const Scene& scene);

/// Sets the near limit of all splats by the user's choice, in world units, and removes the remarks
/// on it. Throws UsageError if the scene has no splats. Needs units >= 0 and finite.
void choose_near_limit(Scene& scene, double units);

}  // namespace tureen
