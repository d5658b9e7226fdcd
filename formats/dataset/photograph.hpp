// One photograph of a dataset: found, decoded, undistorted, scaled.
#pragma once

#include <filesystem>
#include <optional>

#include "base/memory_budget.hpp"
#include "formats/dataset/alpha.hpp"
#include "formats/dataset/dataset.hpp"
#include "formats/dataset/dataset_frame.hpp"
#include "formats/dataset/near_files.hpp"

namespace tureen {

/// The frame's file, or nullopt if there is none: the name as stored, or a near one. In a folder of
/// smaller images another suffix may replace the name's own.
std::optional<NearFiles::Found> find_image(const DatasetFrame& frame, int images_folder,
                                           NearFiles& files);

/// The width or height of an image with `side` pixels at this scale: rounded, at least 1.
int scaled_side(int side, double scale);

/// The mask of the frame, or nullopt if it has none: the one that the dataset names, otherwise
/// NAME.png, NAME.EXT.png or NAME.EXT of the image NAME.EXT in the dataset's folder masks, or
/// masks_N. Throws InputError if a named file is missing.
std::optional<std::filesystem::path> find_mask(const DatasetFrame& frame, int images_folder,
                                               NearFiles& files);

struct FoundPhotograph {
  std::filesystem::path image;
  std::optional<std::filesystem::path> mask;
};

struct ReadPhotograph {
  Photograph photograph;
  /// Cropped columns and rows of the scaled image, which had no source.
  int lost_columns = 0, lost_rows = 0;
  /// How many times smaller than the camera's the image is, beyond its folder; 1: as large.
  int shrunk = 1;
  AlphaCounts alpha = {};
  bool was_turned = false;  // by its EXIF orientation
  /// That which the camera does not have; 1: none.
  int ignored_orientation = 1;
};

/// Decodes the photograph and scales it by `options.scale`. A pixel is ignored if any pixel of the
/// photograph that contributes to it is excluded: 0 in the red, green and blue of the mask, which
/// may be an integer factor larger than the image. An image with the sides of its camera exchanged
/// is turned by its EXIF orientation. An image that is smaller than its camera by an integer factor
/// up to 16, rounded up or down, gets a smaller camera. Throws InputError with the image: it cannot
/// be decoded, its size does not match, the lens leaves less than half of it, the mask has another
/// size or leaves no pixel, or the budget is exceeded. Charges the photograph's memory to the
/// budget.
ReadPhotograph read_photograph(const DatasetFrame& frame, const FoundPhotograph& found,
                               const DatasetOptions& options, const MemoryBudget& budget);

}  // namespace tureen
