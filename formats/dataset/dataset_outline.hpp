// What a dataset lists, before its photographs are read.
#pragma once

#include <filesystem>
#include <string>

#include "base/memory_budget.hpp"
#include "formats/dataset/dataset.hpp"
#include "formats/dataset/dataset_split.hpp"

namespace tureen {

struct DatasetOutline {
  std::string file = {};  // the file that lists the photographs, for messages
  Frames train = {}, test = {};
  Dataset dataset = {};   // all but the photographs
  int images_folder = 1;  // DatasetOptions::images_folder, or that of the only folder
  /// Whether the dataset can do without the test views: they are not part of a split by number.
  bool has_own_test = false;
};

/// The mean of scattered up axes is shorter, and is no up.
inline constexpr double least_mean_up = 0.1;

/// Throws InputError: the folder is no dataset, or a file of it cannot be read.
DatasetOutline read_outline(const std::filesystem::path& path, const DatasetOptions& options,
                            const MemoryBudget& budget);

}  // namespace tureen
