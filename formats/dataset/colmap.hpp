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
  Camera pinhole = {};
  Lens lens = {};
  bool is_panorama = false;  // EQUIRECTANGULAR: `pinhole` has only its size
  std::string defect = {};   // why its images cannot be used; empty: they can
};

struct ColmapImage {
  std::uint32_t number = 0;  // COLMAP's
  std::string name;          // relative to the folder of images, as spelled in the file
  std::uint32_t camera = 0;
  glm::dmat4 view_from_world{1.0};
  std::string defect = {};  // of its pose; empty: none
};

using ColmapCameras = std::map<std::uint32_t, ColmapCamera>;  // by COLMAP's id

struct ColmapPoints {
  std::vector<DatasetPoint> points;  // in file order
  std::size_t skipped = 0;           // points with a position that is not finite
};

/// A point with the images that show it.
struct ColmapTrack {
  glm::dvec3 position{0.0};
  double error = 0;                   // mean distance of its projections from their features, px
  std::vector<std::uint32_t> images;  // ColmapImage::number, one for each feature
};

struct ColmapModel {
  ColmapCameras cameras;
  std::vector<ColmapImage> images;  // in file order
  ColmapPoints points;              // empty if the file is missing
};

/// The folders of a dataset's models, in order: those in sparse, colmap/sparse and
/// undistorted/sparse with a number, those folders themselves, and the dataset's own folder. Only
/// the first place with files of cameras counts; COLMAP writes several models if it cannot join the
/// photographs.
std::vector<std::filesystem::path> colmap_folders(const std::filesystem::path& dataset);

/// The images without a defect.
std::size_t usable_images(const ColmapModel& model);

/// The folder of the model with the most usable images; the only one is not opened. `folders` are
/// not empty. Throws the errors of read_colmap_poses.
std::filesystem::path largest_model(const std::vector<std::filesystem::path>& folders,
                                    const MemoryBudget& budget = MemoryBudget());

/// Whether `folder` itself contains a model: files of cameras and of images.
bool is_colmap_model(const std::filesystem::path& folder);

/// Reads cameras, images and points3D from `folder`, binary if both variants exist. An image whose
/// pose is not a rotation, or whose camera is missing or has an unsupported model, has a defect.
/// Throws InputError with the file and the byte or line:
/// counts that do not match the bytes, or text that is no record.
ColmapModel read_colmap(const std::filesystem::path& folder,
                        const MemoryBudget& budget = MemoryBudget());

/// The same without the points, which may number millions.
ColmapModel read_colmap_poses(const std::filesystem::path& folder,
                              const MemoryBudget& budget = MemoryBudget());

/// Only the points; none if their file is missing.
ColmapPoints read_colmap_points(const std::filesystem::path& folder,
                                const MemoryBudget& budget = MemoryBudget());

/// The points of a binary model with the images that show them.
std::vector<ColmapTrack> read_colmap_tracks(const std::filesystem::path& folder,
                                            const MemoryBudget& budget = MemoryBudget());

// The individual files, from untrusted bytes.

ColmapCameras read_colmap_cameras_binary(Input& input);
ColmapCameras read_colmap_cameras_text(Input& input);
std::vector<ColmapImage> read_colmap_images_binary(Input& input);
std::vector<ColmapImage> read_colmap_images_text(Input& input);
ColmapPoints read_colmap_points_binary(Input& input);
ColmapPoints read_colmap_points_text(Input& input);
std::vector<ColmapTrack> read_colmap_tracks_binary(Input& input);

}  // namespace tureen
