// A dataset named on the command line, read with progress.
#pragma once

#include <limits>
#include <string>

#include "cli/options/arguments.hpp"
#include "formats/dataset/dataset.hpp"

namespace tureen::cli {

struct DatasetArgument {
  std::string path;
  DatasetOptions options;  // except `part` and `progress`, which are not arguments
};

/// Adds DATASET, --scale, --images, --test-every, --alpha and --strict. Returns DATASET, which is
/// required. `argument` must live until the arguments are parsed.
Option add_dataset_argument(Command& command, DatasetArgument& argument);

/// --scale alone. Its error names --resize if the command has that option already.
Option add_scale_option(Command& command, DatasetArgument& argument);

/// Side of the SSIM window in pixels; smaller images have no SSIM.
inline constexpr int ssim_window = 11;

/// Bounds of an image's sides, in pixels.
struct SideLimits {
  int least = 1;
  int most = std::numeric_limits<int>::max();
};

/// Throws InputError with the name and size of the first photograph beyond the limits.
void require_sides(const DatasetArgument& argument, const Dataset& dataset, SideLimits limits);

/// Throws InputError, with a suggestion if the path does not exist, and Interrupted.
Dataset read(const DatasetArgument& argument, DatasetPart part);

}  // namespace tureen::cli
