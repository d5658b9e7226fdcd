// The room before the cameras, where a photograph shows no surface.
//
// A triangle that hangs before one camera alone may explain its photograph perfectly: no other
// photograph looks at that place, so nothing contradicts it, and every view beside it is spoilt.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/camera.hpp"
#include "scene/photographs.hpp"
#include "trainer/common/region.hpp"
#include "trainer/diffsoup/config.hpp"
#include "trainer/diffsoup/model.hpp"

namespace tureen::trainer {

/// One a face: not 0 where some part of it lies in the image of one of `cameras` and nearer to
/// its plane than `near` (world units, more than 0). Exact but for rounding: faces that surround
/// the pyramid count only if they cut it. Corners that are not finite are in no image.
std::vector<std::uint8_t> reaching_near_zone(const Model& model, std::span<const Camera> cameras,
                                             double near);

/// A configuration (its lengths in the dataset's units) whose near zone is empty as far as the
/// dataset tells, where faces are removed from it (clear_near): `near` is at most half the distance
/// of the points that are in the images, the nearest hundredth of them left out, or, without
/// points, half the distance at which the cameras look at the region's centre. Where most have
/// that at their back, as in a room, nothing is known: then near is the published one and no face
/// is removed.
Config with_empty_near_zone(const Config& config, const Dataset& dataset, const Region& region);

}  // namespace tureen::trainer
