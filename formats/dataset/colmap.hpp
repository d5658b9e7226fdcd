// A reconstruction by COLMAP: https://colmap.github.io/format.html, text or binary. World
// coordinates are the reconstruction's own; poses are converted to the OpenGL convention.
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

/// Intrinsics that several images may share. `pinhole` has no name and no pose; its principal
/// point, as COLMAP's, is measured from the corner of the image.
struct ColmapCamera {
  Camera pinhole;
  Lens lens;
};

struct ColmapImage {
  std::string name;  // below the folder of images, as the file spells it
  std::uint32_t camera = 0;
  glm::dmat4 view_from_world{1.0};
};

using ColmapCameras = std::map<std::uint32_t, ColmapCamera>;  // by COLMAP's number

struct ColmapModel {
  ColmapCameras cameras;
  std::vector<ColmapImage> images;   // in the file's order; each one's camera is in `cameras`
  std::vector<DatasetPoint> points;  // in the file's order; empty where the file is missing
};

/// The folder of the model of a dataset: sparse/0, sparse or colmap/sparse/0 of `dataset`, or
/// nothing where none of them holds a file of cameras.
std::optional<std::filesystem::path> colmap_folder(const std::filesystem::path& dataset);

/// Whether `folder` itself holds a model: files of cameras and of images.
bool is_colmap_model(const std::filesystem::path& folder);

/// Reads cameras, images and points3D from `folder`, binary where there are both. Throws InputError
/// with the file and the byte or line: a camera model that is none of SIMPLE_PINHOLE, PINHOLE,
/// SIMPLE_RADIAL, RADIAL and OPENCV, by its name; a pose that is no rotation; counts that do not
/// fit the bytes; an image of a camera that is not there.
ColmapModel read_colmap(const std::filesystem::path& folder,
                        const MemoryBudget& budget = MemoryBudget());

/// The same without the points, of which there may be millions.
ColmapModel read_colmap_poses(const std::filesystem::path& folder,
                              const MemoryBudget& budget = MemoryBudget());

// The files one by one, from untrusted bytes.

ColmapCameras read_colmap_cameras_binary(Input& input);
ColmapCameras read_colmap_cameras_text(Input& input);
std::vector<ColmapImage> read_colmap_images_binary(Input& input);
std::vector<ColmapImage> read_colmap_images_text(Input& input);
std::vector<DatasetPoint> read_colmap_points_binary(Input& input);
std::vector<DatasetPoint> read_colmap_points_text(Input& input);

}  // namespace tureen
