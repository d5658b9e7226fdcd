// Cameras in the format of the NeRF datasets (Mildenhall et al., arXiv 2003.08934).
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "scene/camera.hpp"

namespace tureen::example {

/// Converts a camera from a world with y up to one with z up: (x, y, z) becomes (x, -z, y).
Camera with_z_up(Camera camera);

/// Writes FOLDER/transforms_SPLIT.json with with_z_up() of each camera. Its frames refer to
/// FOLDER/SPLIT/NAME.png, where NAME is the camera's name. All cameras must have square pixels, a
/// centred principal point and the same angle of view, since the format stores only one angle.
/// Throws OutputError.
void write_transforms(const std::filesystem::path& folder, const std::string& split,
                      std::span<const Camera> cameras);

}  // namespace tureen::example
