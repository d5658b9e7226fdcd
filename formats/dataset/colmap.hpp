// A COLMAP reconstruction (https://colmap.github.io/format.html), text or binary. World coordinates
// are those of the reconstruction; poses are converted to the OpenGL convention.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/input.hpp"
#include "formats/dataset/dataset.hpp"
#include "formats/dataset/lens.hpp"
#include "scene/camera.hpp"

namespace tureen {

/// Intrinsics, possibly shared by several images. `pinhole` has neither name nor pose. Its
/// principal point is measured from the corner of the image, as in COLMAP.
struct ColmapCamera {
  Camera pinhole;
  Lens lens;
};

struct ColmapImage {
  std::string name;  // relative to the folder of images, as spelled in the file
  std::uint32_t camera = 0;
  glm::dmat4 view_from_world{1.0};
};

using ColmapCameras = std::map<std::uint32_t, ColmapCamera>;  // by COLMAP's id

struct ColmapModel {
  ColmapCameras cameras;
  std::vector<ColmapImage> images;   // in file order; each image's camera is in `cameras`
  std::vector<DatasetPoint> points;  // in file order; empty if the file is missing
};

/// The folder of a dataset's model: sparse/0, sparse or colmap/sparse/0 in `dataset`, or nullopt if
/// no such folder has a file of cameras.
std::optional<std::filesystem::path> colmap_folder(const std::filesystem::path& dataset);

/// Whether `folder` itself contains a model: files of cameras and of images.
bool is_colmap_model(const std::filesystem::path& folder);

/// Reads cameras, images and points3D from `folder`, binary if both variants exist. Throws
/// InputError with the file and the byte or line: an unsupported camera model, by its name
/// (supported: SIMPLE_PINHOLE, PINHOLE, SIMPLE_RADIAL, RADIAL, OPENCV, OPENCV_FISHEYE,
/// SIMPLE_RADIAL_FISHEYE, RADIAL_FISHEYE), a pose that is not a rotation, counts that do not match
/// the bytes, or an image with a missing camera.
ColmapModel read_colmap(const std::filesystem::path& folder,
                        const MemoryBudget& budget = MemoryBudget());

/// The same without the points, which may number millions.
ColmapModel read_colmap_poses(const std::filesystem::path& folder,
                              const MemoryBudget& budget = MemoryBudget());

/// Only the points; none if their file is missing.
std::vector<DatasetPoint> read_colmap_points(const std::filesystem::path& folder,
                                             const MemoryBudget& budget = MemoryBudget());

// The individual files, from untrusted bytes.

ColmapCameras read_colmap_cameras_binary(Input& input);
ColmapCameras read_colmap_cameras_text(Input& input);
std::vector<ColmapImage> read_colmap_images_binary(Input& input);
std::vector<ColmapImage> read_colmap_images_text(Input& input);
std::vector<DatasetPoint> read_colmap_points_binary(Input& input);
std::vector<DatasetPoint> read_colmap_points_text(Input& input);

}  // namespace tureen
