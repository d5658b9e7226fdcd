// The empty space in front of the cameras, where photographs show no surface.
//
// A triangle right in front of one camera may fit its photograph perfectly. No other photograph
// shows that place, so no loss corrects the triangle, and it spoils all neighbouring views.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/camera.hpp"
#include "scene/photographs.hpp"
#include "scene/region.hpp"
#include "trainer/diffsoup/config.hpp"
#include "trainer/diffsoup/model.hpp"

namespace tureen::trainer {

/// One value per face: not 0 if a part of it lies in the image of one of `cameras` and nearer to
/// its plane than `near` (world units, more than 0). The test is exact within rounding: a face
/// around the pyramid counts only if it cuts it. Corners that are not finite are in no image.
std::vector<std::uint8_t> reaching_near_zone(const Model& model, std::span<const Camera> cameras,
                                             double near);

/// Limits `near` for clear_near, so that the near zone contains no surface according to the
/// dataset. Lengths are in the dataset's units. `near` is at most
///   - half the distance to the points in the images, without the nearest 1 % of them;
///   - without points, half the median distance from the cameras to the region's centre;
///   - if most cameras have the centre behind them, as inside a room: the published `near`.
/// In the last case clear_near becomes false. `near` is never below the published one unless
/// config.near is.
Config with_empty_near_zone(const Config& config, const Dataset& dataset, const Region& region);

}  // namespace tureen::trainer
