// Scenes of small or large units. Splats nearer than 0.2 units are not drawn
// (SplatProfile::min_center_depth, a rule of the published methods), so a scene of a few
// centimetres in metres would be empty. It is trained at a larger scale, and its layer is scaled
// back: the limit, in the layer's units, stays that of the profile.
#pragma once

#include "scene/photographs.hpp"
#include "scene/scene.hpp"

namespace tureen {

/// 1 if the cameras are usually 1 to 100 units away from what they look at (the median distance to
/// the centre of the region of interest, or its half side if that is larger), otherwise the power
/// of two that makes this distance about 4. A power of two rounds no coordinate. Throws the errors
/// of region_of_interest.
double training_scale(const Dataset& dataset);

/// Multiplies the coordinates of cameras and points.
void scale_dataset(Dataset& dataset, double scale);

/// Scales the layers and cameras of a scene; their primitives stay.
Scene scaled_scene(Scene scene, double scale);

}  // namespace tureen
