// A cloud of coloured points in a PLY file, as programs beside COLMAP store the start of a
// training.
#pragma once

#include <cstddef>
#include <vector>

#include "base/input.hpp"
#include "scene/photographs.hpp"

namespace tureen {

struct PointsPly {
  std::vector<DatasetPoint> points;
  std::size_t skipped = 0;  // rows with a number that is not finite
};

/// The rows of the element "vertex": x, y and z, and a colour: red, green and blue, r, g and b, or
/// diffuse_red and so on, as bytes, 16 bits, integers to 255, or floats to 1 or to 255; or the
/// harmonics f_dc_0 and so on of splats. Without colours, points are grey. Other properties and
/// elements are skipped. Throws InputError with the line or byte: no element "vertex", or no
/// coordinate. An element without rows is an empty cloud.
PointsPly read_points_ply(Input& input);

}  // namespace tureen
