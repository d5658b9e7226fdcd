// A dataset named on the command line: read with progress, refused with a suggestion.
#pragma once

#include <CLI/App.hpp>
#include <string>

#include "formats/dataset.hpp"

namespace tureen::cli {

struct DatasetArgument {
  std::string path;
  DatasetOptions options;  // but for `part` and `progress`, which are not arguments
};

/// Adds DATASET, --scale, --images and --test-every. `argument` must live until the arguments are
/// parsed.
void add_dataset_argument(CLI::App& command, DatasetArgument& argument);

/// --scale alone.
CLI::Option* add_scale_option(CLI::App& command, DatasetArgument& argument);

/// Throws InputError, with a suggestion where the path does not exist, and Interrupted.
Dataset read(const DatasetArgument& argument, DatasetPart part);

}  // namespace tureen::cli
