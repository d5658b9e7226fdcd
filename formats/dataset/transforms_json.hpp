// transforms.json in the variants of NeRF-synthetic, instant-ngp and their descendants. Matrices
// map from the camera, in the OpenGL convention, to the world. A frame's own value overrides the
// one for all frames.
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
  std::string file_path;  // as spelled in the file; empty if missing
  std::optional<int> width, height;
  /// In pixels. At least one of fl_x, fl_y and the two angles (radians, full) is present.
  std::optional<double> fl_x, fl_y, cx, cy;
  std::optional<double> camera_angle_x, camera_angle_y;
  Lens lens;
  /// The mask of the image, as spelled in the file; empty if missing. Black pixels (0) are not
  /// used.
  std::string mask_path;
  /// The file's name for a lens property that Lens does not support: "latlong".
  std::string other_lens;
  glm::dmat4 view_from_world{1.0};  // rigid to the last digit
};

/// The frames in the file's order. Throws InputError with the frame and the reason: a number
/// missing or out of range, a matrix that is not a rotation to three digits.
std::vector<TransformsFrame> read_transforms(const nlohmann::json& root, const std::string& file);

/// The frame's pinhole for an image of this size in pixels. Without a principal point in the file
/// it is the centre.
Camera pinhole(const TransformsFrame& frame, int width, int height);

}  // namespace tureen
