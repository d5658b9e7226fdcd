// Cameras as the datasets of NeRF (Mildenhall et al., arXiv 2003.08934) hold them.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "scene/camera.hpp"

namespace tureen::example {

/// The camera of a world with y up in the world with z up: there (x, y, z) is (x, -z, y).
Camera with_z_up(Camera camera);

/// Writes FOLDER/transforms_SPLIT.json, whose frames are FOLDER/SPLIT/NAME.png by the cameras'
/// names. All cameras have square pixels, the principal point in the middle and the same angle of
/// view: the format holds no more. What is written is with_z_up(camera), as the format has it.
/// Throws OutputError.
void write_transforms(const std::filesystem::path& folder, const std::string& split,
                      std::span<const Camera> cameras);

}  // namespace tureen::example
