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
  LensNumbers lens;
  bool is_fisheye = false;   // then of fisheye_model, otherwise of brown_model
  bool is_panorama = false;  // equirectangular: it has neither focal length nor lens
  /// The mask of the image, as spelled in the file; empty if missing. Black pixels (0) are not
  /// used.
  std::string mask_path;
  /// The file's name for a lens property that is not supported: "latlong".
  std::string other_lens;
  glm::dmat4 view_from_world{1.0};  // rigid to the last digit
  std::string defect;               // why the frame cannot be used; empty: it can

  bool is_distorted() const { return is_fisheye || !other_lens.empty() || lens != LensNumbers{}; }
};

/// The frames in the file's order. One with a number that is missing or out of range, or a matrix
/// that is not a rotation to three digits, has a defect. `key`: of the list of frames. Throws
/// InputError if there is none.
std::vector<TransformsFrame> read_transforms(const nlohmann::json& root, const std::string& file,
                                             const char* key = "frames");

/// The frame's pinhole for an image of this size in pixels. Without a principal point in the file
/// it is the centre.
Camera pinhole(const TransformsFrame& frame, int width, int height);

}  // namespace tureen
