// The photographs that a transforms.json names, in its own folder or below.
#pragma once

#include <filesystem>
#include <vector>

#include "base/memory_budget.hpp"
#include "formats/dataset/dataset_frame.hpp"

namespace tureen {

/// In the file's order. `images_folder` as in DatasetOptions: "images/" at the beginning of a name
/// becomes "images_4/". Throws InputError with the frame and the reason: no file_path, a lens that
/// cannot be undone by its name, a name outside of images/ where another folder is asked for.
std::vector<DatasetFrame> read_transforms_dataset(const std::filesystem::path& path,
                                                  int images_folder,
                                                  const MemoryBudget& budget = MemoryBudget());

}  // namespace tureen
