// Camera files of all kinds, detected by content: our own JSON, which keeps every digit; NeRF's
// transforms.json; cameras.json of 3D Gaussian Splatting; a COLMAP model, binary or text.
//
// Ours, version 1 (the "cameras" that `tureen info --json` prints are read as well):
//   { "tureen_cameras": 1,
//     "cameras": [ { "name": "front", "width": 640, "height": 360, "fx": 500.0, "fy": 500.0,
//                    "cx": 320.0, "cy": 180.0,
//                    "view_from_world": [[4 numbers], [4 numbers], [4 numbers]] } ] }
// with the pixels and axes of scene/camera.hpp. The three rows of view_from_world are a rotation
// and, in the last column, a translation. "name" is optional.
//
// A path is the same file with times, so every reader of cameras also reads its keyframes
// (docs/camera-paths.md):
//   { "tureen_cameras": 1, "loop": true, "loop_seconds": 8.0,
//     "cameras": [ { "seconds": 0.0, "target_distance": 2.5, and the fields of a camera }, .. ] }
// Times are at least 0 and do not decrease. "target_distance", "loop" (default false) and
// "loop_seconds" are optional. Without "loop_seconds", the time from the last keyframe of a loop
// back to the first is the average time between consecutive keyframes.
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
  std::vector<Remark> remarks;  // assumptions and losses of the reader
};

/// Whether read_cameras(path) supports the path: a file that begins like JSON, or a COLMAP model.
/// Not for scenes, which may also contain cameras.
bool is_camera_file(const std::filesystem::path& path);

/// transforms.json has camera-to-world matrices in the OpenGL convention. It has fl_x, fl_y, cx,
/// cy, w, h or only camera_angle_x, for all frames or for each. Without an image size the reader
/// assumes 800 x 800, the size of NeRF's synthetic scenes, and adds a remark. Lens distortion is
/// dropped with a remark. The name of a camera is its image's path as spelled in the file.
/// cameras.json of 3D Gaussian Splatting: see gaussian_cameras() in camera_file.cpp.
/// Throws InputError with the file and the reason: invalid JSON (with the byte), a number missing
/// or out of range, a matrix that is not a rotation to three digits.
CameraFile read_cameras(Input& input);

/// The same from a file or a COLMAP model. A model is named by its folder, by one of its files of
/// cameras or images, or by the folder of a dataset with sparse/0, sparse or colmap/sparse/0. Its
/// cameras are sorted by image name, as in a dataset (formats/dataset/dataset.hpp); distortion is
/// dropped with a remark. COLMAP is not supported in a browser.
CameraFile read_cameras(const std::filesystem::path& path);

/// Writes our own format; reading it back gives the same bits.
std::string cameras_to_json(std::span<const Camera> cameras);

/// Reads a path in our own format, with at least one keyframe. Throws InputError like read_cameras.
/// It also throws, with the camera, if a time is missing, negative, above 1,000,000 or below the
/// previous one. It throws if "loop" is not a boolean or its seconds are invalid, and for other
/// formats.
CameraPathData read_path(Input& input);
CameraPathData read_path(const std::filesystem::path& path);

/// Writes a path; reading it back gives the same bits. Asserts times that do not decrease.
std::string path_to_json(const CameraPathData& path);

}  // namespace tureen
