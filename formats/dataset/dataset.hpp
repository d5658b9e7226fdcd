// Reads posed photographs:
//   transforms.json
//       instant-ngp, Nerfstudio: one file, intrinsics for all frames or frame by frame
//   transforms_{train,test}.json
//       NeRF-synthetic: one file per split (transforms_val.json is not read)
//   sparse/0, sparse or colmap/sparse/0 with cameras, images and points3D as .bin or .txt, and
//   images/
//       COLMAP, https://colmap.github.io/format.html
//   bundle.out and list.txt
//       Bundler, see formats/dataset/bundler.hpp
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "scene/photographs.hpp"

namespace tureen {

/// The photographs to read; others are not opened. `all`: a dataset may have no test views.
enum class DatasetPart { train, test, all };

struct DatasetOptions {
  /// Scale of the width and height of the stored images, in (0, 1], default 1. 0.5 halves both, by
  /// area filtering weighted by alpha. Intrinsics are scaled exactly.
  double scale = 1.0;
  /// Reads images_N (a folder beside images in 360_v2) instead of images; 1 means images.
  int images_folder = 1;
  /// For datasets without a split: every n-th photograph in name order, beginning with the first,
  /// is a test view. The only photograph of a dataset is a training view, unless `part` is test.
  int test_every = 8;
  DatasetPart part = DatasetPart::all;
  /// Called with the fraction done, 0..1; may throw to cancel.
  std::function<void(double)> progress = nullptr;
};

/// Reads a folder, or a transforms.json. Photographs are sorted by the bytes of their names: r_10
/// precedes r_2. Their names are relative to the dataset's folder; ".." and symbolic links may lead
/// out of it. JPEG's EXIF orientation is not applied, since cameras refer to the stored pixels.
///
/// Throws InputError with the file and the reason: missing images (all are named, up to a dozen),
/// an image size that differs from the camera's, a camera model whose distortion cannot be removed,
/// a pose whose matrix differs from a rotation by more than about 0.001, a part without
/// photographs, or photographs that exceed the memory budget (base/memory_budget.hpp).
Dataset read_dataset(const std::filesystem::path& path, const DatasetOptions& options = {});

/// The lens of a photograph before read_dataset() resamples it to a pinhole image.
enum class LensKind { pinhole, distorted, fisheye };

/// A dataset without the pixels of its photographs.
struct DatasetSummary {
  struct View {
    Camera camera;  // for the stored image, without its distortion
    LensKind lens = LensKind::pinhole;
    bool has_mask = false;
  };
  std::vector<View> train, test;  // in the order of Dataset
  std::vector<DatasetPoint> points;
  glm::vec3 up{0.0f, 1.0f, 0.0f};
  std::vector<Remark> remarks;  // without those about pixels
};

/// Finds all photographs, but decodes only those whose size the dataset does not store; of images
/// that must be of equal size, the first. Ignores `options.scale` and `options.progress`. Throws
/// InputError for missing images and the reasons of read_dataset() that need no pixels.
DatasetSummary read_dataset_summary(const std::filesystem::path& path,
                                    const DatasetOptions& options = {});

/// Whether `path` is a folder with the files of one of the forms above, or a file whose name begins
/// with "transforms" and ends in ".json". Opens no file.
bool is_dataset(const std::filesystem::path& path);

}  // namespace tureen
