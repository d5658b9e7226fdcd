// Cameras of all kinds, told by content: our own JSON, which keeps every digit; NeRF's
// transforms.json; cameras.json of 3D Gaussian Splatting; a model by COLMAP, binary or text.
//
// Ours, version 1 (the "cameras" that `tureen info --json` prints are read as well):
//   { "tureen_cameras": 1,
//     "cameras": [ { "name": "front", "width": 640, "height": 360, "fx": 500.0, "fy": 500.0,
//                    "cx": 320.0, "cy": 180.0,
//                    "view_from_world": [[4 numbers], [4 numbers], [4 numbers]] } ] }
// with the pixels and axes of scene/camera.hpp; the three rows of view_from_world are those of a
// rotation and, in the last column, a translation. "name" may be missing.
//
// A path is the same file with times, so that whatever reads cameras reads its keyframes
// (docs/camera-paths.md):
//   { "tureen_cameras": 1, "loop": true, "loop_seconds": 8.0,
//     "cameras": [ { "seconds": 0.0, "target_distance": 2.5, and what a camera has }, .. ] }
// Times are 0 or more and do not decrease. "target_distance" may be missing, "loop" as well
// (false), and "loop_seconds" where there is no loop; a loop without it closes in the mean time
// between its keyframes.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "base/input.hpp"
#include "scene/camera.hpp"
#include "scene/camera_path_data.hpp"
#include "scene/remark.hpp"

namespace tureen {

struct CameraFile {
  std::vector<Camera> cameras;
  std::vector<Remark> remarks;  // what reading assumed or lost
};

/// Whether read_cameras(path) is the door to knock at: a file that begins as JSON does, or COLMAP's
/// model. Not for scenes, which may have cameras, too.
bool is_camera_file(const std::filesystem::path& path);

/// transforms.json holds camera-to-world matrices in the OpenGL convention, and either fl_x, fl_y,
/// cx, cy, w, h or only camera_angle_x, for all frames or frame by frame. Without an image size
/// 800 x 800 is assumed, NeRF's synthetic scenes, and a note says so; lens distortion is left out
/// with a note. The name of a camera is its image's path as the file spells it.
/// cameras.json of 3D Gaussian Splatting: formats/dataset/gaussian_cameras.hpp.
/// Throws InputError with the file and what is wrong: JSON that does not parse (with the byte), a
/// number missing or out of range, a matrix that is no rotation to three digits.
CameraFile read_cameras(Input& input);

/// The same from a file; or COLMAP's model, named by its folder, by one of its files of cameras or
/// images, or by the folder of a dataset that has it in sparse/0, sparse or colmap/sparse/0. Its
/// cameras come in the order of their images' names, as those of a dataset do
/// (formats/dataset/dataset.hpp); distortion is left out with a note. In a browser there is no
/// COLMAP.
CameraFile read_cameras(const std::filesystem::path& path);

/// Our own file; reading it back gives the same bits.
std::string cameras_to_json(std::span<const Camera> cameras);

/// A path of ours, with at least one keyframe. Throws InputError like read_cameras, and with the
/// camera where a time is missing, negative, above 1,000,000 or less than that before; where "loop"
/// is neither true nor false or its seconds make no sense; and for files of others.
CameraPathData read_path(Input& input);
CameraPathData read_path(const std::filesystem::path& path);

/// Reading it back gives the same bits. Asserts times that do not decrease.
std::string path_to_json(const CameraPathData& path);

}  // namespace tureen
