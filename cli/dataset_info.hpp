// `tureen info` of a dataset instead of a scene.
#pragma once

#include <string>

namespace tureen::cli {

struct DatasetInfoOptions {
  std::string path;
  std::string plot;  // the SVG file to write; empty: none
  bool json = false;
};

/// Prints the contents of a dataset, and writes the plot. Throws InputError, UsageError and
/// OutputError.
void inform_of_dataset(const DatasetInfoOptions& options);

}  // namespace tureen::cli
