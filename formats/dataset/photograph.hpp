// One photograph of a dataset: found, decoded, undistorted, scaled.
#pragma once

#include <filesystem>
#include <optional>

#include "base/memory_budget.hpp"
#include "formats/dataset/dataset.hpp"
#include "formats/dataset/dataset_frame.hpp"

namespace tureen {

/// The frame's file, or nothing where there is none: the name as it is, or with the extension that
/// NeRF-synthetic leaves out (.png, .jpg, .jpeg, small or capital). In a folder of smaller images
/// another extension may stand in the place of the name's own. Throws UriError for a name that
/// leads out of the frame's folder.
std::optional<std::filesystem::path> find_picture(const DatasetFrame& frame, int images_folder);

/// The width or height of a picture of `side` pixels at this scale: rounded, at least 1.
int scaled_side(int side, double scale);

struct ReadPhotograph {
  Photograph photograph;
  /// Columns and rows of the scaled picture that had no source and were cut off.
  int lost_columns = 0, lost_rows = 0;
};

/// Decodes `picture` and brings it to `options.scale`. Throws InputError with the picture: it
/// cannot be decoded, its size is not the camera's, the lens leaves less than half of it, the
/// budget has too little left. Of the budget it keeps what the photograph takes.
ReadPhotograph read_photograph(const DatasetFrame& frame, const std::filesystem::path& picture,
                               const DatasetOptions& options, const MemoryBudget& budget);

}  // namespace tureen
