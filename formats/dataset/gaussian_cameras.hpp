// cameras.json as 3D Gaussian Splatting and its descendants write it beside a model:
//   [ { "id": 0, "img_name": "0001", "width": 640, "height": 360, "position": [3 numbers],
//       "rotation": [[3 numbers], [3 numbers], [3 numbers]], "fx": 500.0, "fy": 500.0 } ]
// position is the eye in world coordinates. The columns of rotation are the camera's axes in the
// world, in OpenCV's convention (x right, y down, looking along +z); the reader converts them to
// OpenGL's.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "scene/camera.hpp"

namespace tureen {

/// The cameras in the list's order, each named by its img_name. Without cx, cy the principal point
/// is the centre: the format does not store it, but some descendants do. Throws InputError with the
/// camera and the reason.
std::vector<Camera> read_gaussian_cameras(const nlohmann::json& list, const std::string& file);

}  // namespace tureen
