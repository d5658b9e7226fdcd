// Reads posed photographs:
//   transforms.json
//       instant-ngp, Nerfstudio, ScanNet++: one file, intrinsics for all frames or frame by frame
//   transforms_{train,test}.json
//       NeRF-synthetic: one file per split; transforms_val.json counts if the test file is missing
//   sparse/N, sparse, colmap/sparse/N or the folder itself with cameras, images and points3D as
//   .bin or .txt, and images/
//       COLMAP, https://colmap.github.io/format.html
//   bundle.out and list.txt
//       Bundler, see formats/dataset/bundler.hpp
// docs/datasets.md has the rules.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "scene/photographs.hpp"

namespace tureen {

/// The photographs to read; others are not opened. `all`: a dataset may have no test views.
enum class DatasetPart { train, test, all };

/// What transparent pixels of photographs are.
enum class AlphaMeaning {
  background,  // behind an object that was cut out
  mask,        // pixels that training and evaluation ignore
  ignore,      // nothing: photographs are opaque
};

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
  std::optional<AlphaMeaning> alpha = {};  // by default, alpha_of() decides
  /// One photograph that cannot be used is an error, instead of being skipped.
  bool is_strict = false;
  /// Called with the fraction done, 0..1; may throw to cancel.
  std::function<void(double)> progress = nullptr;
};

/// Reads a folder, or a transforms.json. Photographs are sorted by the bytes of their names: r_10
/// precedes r_2. Their names are relative to the dataset's folder, or absolute; ".." and symbolic
/// links may lead out of it.
///
/// A photograph is skipped, with a remark, if it is missing, cannot be decoded, has another size
/// than its camera, an unsupported lens, a pose whose matrix differs from a rotation by more than
/// about 0.001, or a named mask that is missing. Throws InputError with the file and the reason:
/// fewer than three photographs are then left, or more are skipped than left; a part without
/// photographs; or one that exceeds the memory budget (base/memory_budget.hpp). Photographs beyond
/// half of the budget are in a temporary file; throws OutputError if that cannot be written.
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
/// InputError for the reasons of read_dataset() that need no pixels.
DatasetSummary read_dataset_summary(const std::filesystem::path& path,
                                    const DatasetOptions& options = {});

/// Whether `path` is a folder with the files of one of the forms above, or a file whose name begins
/// with "transforms" and ends in ".json". Opens no file.
bool is_dataset(const std::filesystem::path& path);

/// The dataset directly above the folder `path`, as an absolute path; nullopt if there is none.
/// Opens no file.
std::optional<std::filesystem::path> dataset_around(const std::filesystem::path& path);

}  // namespace tureen
