// A cloud of coloured points in a PLY file, as Nerfstudio's transforms.json names it.
#pragma once

#include <vector>

#include "base/input.hpp"
#include "scene/photographs.hpp"

namespace tureen {

/// The rows of the element "vertex": x, y and z, and red, green and blue as integers from 0 to 255.
/// Without colours, points are grey. Other properties and elements are skipped. Throws InputError
/// with the line or byte: no element "vertex", a missing or non-finite coordinate, a colour of
/// another type. An element without rows is an empty cloud.
std::vector<DatasetPoint> read_points_ply(Input& input);

}  // namespace tureen
