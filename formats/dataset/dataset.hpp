// Reads posed photographs:
//   transforms.json           instant-ngp: one file, intrinsics for all frames or frame by frame
//   transforms_{train,test}.json   NeRF-synthetic: a file a split (transforms_val.json is not read)
//   sparse/0, sparse or colmap/sparse/0 with cameras, images and points3D as .bin or .txt, and
//   images/                   COLMAP, https://colmap.github.io/format.html
#pragma once

#include <filesystem>
#include <functional>

#include "scene/photographs.hpp"

namespace tureen {

/// Which photographs to read; the others cost nothing.
enum class DatasetPart { train, test, all };

struct DatasetOptions {
  /// Of the width and height of the pictures that are there: 0.5 halves both, by area filtering
  /// that weighs colour by alpha. In (0, 1]. Intrinsics follow exactly.
  double scale = 1.0;
  /// Reads images_N (a folder that 360_v2 has beside images) instead of images; 1 is images.
  int images_folder = 1;
  /// Where the dataset has no split of its own, every n-th photograph in name order, beginning
  /// with the first, is a test view.
  int test_every = 8;
  DatasetPart part = DatasetPart::all;
  /// Called now and then with the fraction done, 0..1; may throw to abandon the read.
  std::function<void(double)> progress = nullptr;
};

/// Reads a folder, or a transforms.json. Photographs come in name order, which is that of the
/// bytes: r_10 stands before r_2. No file outside of the dataset's folder is opened. JPEG's EXIF
/// orientation is not applied: cameras speak of pixels as they are stored.
///
/// Throws InputError with the file and the reason: images that are missing (all of them are named,
/// up to a dozen) or whose size is not the camera's, a camera model that cannot be undone, a pose
/// that is no rotation to three digits, a split that would leave nothing to train on or to test,
/// photographs that take more memory together than reading may (base/memory_budget.hpp).
Dataset read_dataset(const std::filesystem::path& path, const DatasetOptions& options = {});

}  // namespace tureen
