// The photographs listed in a transforms.json, in its own folder or below.
#pragma once

#include <filesystem>
#include <vector>

#include "base/memory_budget.hpp"
#include "formats/dataset/dataset_frame.hpp"

namespace tureen {

/// In the file's order. `images_folder` as in DatasetOptions: a leading "images/" in a name becomes
/// "images_4/". Throws InputError with the frame and the reason: no file_path, a lens that cannot
/// be undone (with its name), or a name outside of images/ if another folder is requested.
std::vector<DatasetFrame> read_transforms_dataset(const std::filesystem::path& path,
                                                  int images_folder,
                                                  const MemoryBudget& budget = MemoryBudget());

}  // namespace tureen
