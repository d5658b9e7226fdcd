// transforms.json as it is written: NeRF-synthetic's, instant-ngp's and what others made of them.
// Matrices go from the camera, in the OpenGL convention, to the world; a frame's own value stands
// above the one for all frames.
#pragma once

#include <glm/mat4x4.hpp>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "formats/dataset/lens.hpp"
#include "scene/camera.hpp"

namespace tureen {

struct TransformsFrame {
  std::string file_path;  // as the file spells it; empty where there is none
  std::optional<int> width, height;
  /// In pixels. Of fl_x, fl_y and the two angles (radians, full) at least one is there.
  std::optional<double> fl_x, fl_y, cx, cy;
  std::optional<double> camera_angle_x, camera_angle_y;
  Lens lens;
  /// What the lens does that Lens cannot describe, as the file calls it: "is_fisheye".
  std::string other_lens;
  glm::dmat4 view_from_world{1.0};  // rigid to the last digit
};

/// The frames in the file's order. Throws InputError with the frame and what is wrong: a number
/// missing or out of range, a matrix that is no rotation to three digits.
std::vector<TransformsFrame> read_transforms(const nlohmann::json& root, const std::string& file);

/// The frame's pinhole for a picture of this size in pixels. Where the file names no principal
/// point it is the centre.
Camera pinhole(const TransformsFrame& frame, int width, int height);

}  // namespace tureen
