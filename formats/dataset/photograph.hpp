// One photograph of a dataset: found, decoded, undistorted, scaled.
#pragma once

#include <filesystem>
#include <optional>

#include "base/memory_budget.hpp"
#include "formats/dataset/dataset.hpp"
#include "formats/dataset/dataset_frame.hpp"

namespace tureen {

/// The frame's file, or nullopt if there is none: the name as stored, or with the extension that
/// NeRF-synthetic omits (.png, .jpg, .jpeg, in lower or upper case). In a folder of smaller images
/// another extension may replace the name's own. Links are followed. Throws UriError for an
/// absolute name.
std::optional<std::filesystem::path> find_image(const DatasetFrame& frame, int images_folder);

/// The width or height of an image with `side` pixels at this scale: rounded, at least 1.
int scaled_side(int side, double scale);

/// The mask of the frame, or nullopt if it has none. Throws UriError like find_image, and
/// InputError if the file is missing.
std::optional<std::filesystem::path> find_mask(const DatasetFrame& frame);

struct ReadPhotograph {
  Photograph photograph;
  /// Cropped columns and rows of the scaled image, which had no source.
  int lost_columns = 0, lost_rows = 0;
};

/// Decodes `image` and scales it by `options.scale`. A pixel is ignored if any pixel
/// of the photograph that contributes to it is excluded: 0 in the red, green and blue of the
/// frame's mask. Throws InputError with the image: it cannot be decoded, its size is not the
/// camera's, the lens leaves less than half of it, the mask has another size or leaves no pixel, or
/// the budget is exceeded. Charges the photograph's memory to the budget.
ReadPhotograph read_photograph(const DatasetFrame& frame, const std::filesystem::path& image,
                               const DatasetOptions& options, const MemoryBudget& budget);

}  // namespace tureen
