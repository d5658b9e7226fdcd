// A smooth path along recorded cameras, for a flight through what the photographs show.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "scene/camera_path_data.hpp"

namespace tureen {

/// An order of the cameras without jumps: the recorded one, if it is at most a fifth longer than a
/// short tour: the nearest camera next, improved by 2-opt, and opened at its longest step. Length
/// counts moved eyes and turned lines of sight. O(n^2) for n cameras.
std::vector<std::size_t> order_along(std::span<const Camera> cameras);

/// The path in this order, smoothed: each keyframe is a mean of the cameras about its place on the
/// tour, weighted by a Gaussian as wide as the interval between keyframes. A tour that ends near
/// its beginning becomes a loop. All keyframes have the first camera's image size, the cameras'
/// median vertical angle, and the principal point in the middle. `seconds`: duration, > 0; default:
/// at half a capture's distance per second, 4 to 120 seconds. Of more than 1,000 cameras, 1,000 are
/// used; cameras that are no pinholes, from damaged files, are left out. Empty without cameras.
CameraPathData path_along(std::span<const Camera> cameras, std::optional<double> seconds = {});

}  // namespace tureen
