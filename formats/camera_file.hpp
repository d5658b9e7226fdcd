// Cameras in JSON: our own file, which keeps every digit, and NeRF's transforms.json.
//
// Ours, version 1 (the "cameras" that `tureen info --json` prints are read as well):
//   { "tureen_cameras": 1,
//     "cameras": [ { "name": "front", "width": 640, "height": 360, "fx": 500.0, "fy": 500.0,
//                    "cx": 320.0, "cy": 180.0,
//                    "view_from_world": [[4 numbers], [4 numbers], [4 numbers]] } ] }
// with the pixels and axes of soup/camera.hpp; the three rows of view_from_world are those of a
// rotation and, in the last column, a translation. "name" may be missing.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "formats/input.hpp"
#include "soup/camera.hpp"

namespace tureen {

struct CameraFile {
  std::vector<Camera> cameras;
  std::vector<std::string> notes;  // what reading assumed or lost, a sentence each
};

/// transforms.json holds camera-to-world matrices in the OpenGL convention, and either fl_x, fl_y,
/// cx, cy, w, h or only camera_angle_x, for all frames or frame by frame. Without an image size
/// 800 x 800 is assumed, NeRF's synthetic scenes, and a note says so; lens distortion is left out
/// with a note. The name of a camera is its image's path as the file spells it.
/// Throws InputError with the file and what is wrong: JSON that does not parse (with the byte), a
/// number missing or out of range, a matrix that is no rotation to three digits.
CameraFile read_cameras(Input& input);
CameraFile read_cameras(const std::filesystem::path& path);

/// Our own file; reading it back gives the same bits.
std::string cameras_to_json(std::span<const Camera> cameras);

}  // namespace tureen
