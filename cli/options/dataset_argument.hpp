// A dataset named on the command line: read with progress, refused with a suggestion.
#pragma once

#include <limits>
#include <string>

#include "cli/options/arguments.hpp"
#include "formats/dataset/dataset.hpp"

namespace tureen::cli {

struct DatasetArgument {
  std::string path;
  DatasetOptions options;  // but for `part` and `progress`, which are not arguments
};

/// Adds DATASET, --scale, --images and --test-every. Returns the first of them, which is required.
/// `argument` must live until the arguments are parsed.
Option add_dataset_argument(Command& command, DatasetArgument& argument);

/// --scale alone.
Option add_scale_option(Command& command, DatasetArgument& argument);

/// The window of the SSIM: smaller images cannot be measured.
inline constexpr int ssim_window = 11;

/// Bounds of an image's sides, in pixels.
struct SideLimits {
  int least = 1;
  int most = std::numeric_limits<int>::max();
};

/// Throws InputError with the name and size of the first photograph that is beyond the limits.
void require_sides(const DatasetArgument& argument, const Dataset& dataset, SideLimits limits);

/// Throws InputError, with a suggestion where the path does not exist, and Interrupted.
Dataset read(const DatasetArgument& argument, DatasetPart part);

}  // namespace tureen::cli
