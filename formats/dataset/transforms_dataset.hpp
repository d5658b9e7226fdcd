// The photographs listed in a transforms.json, by paths relative to its folder.
#pragma once

#include <filesystem>
#include <vector>

#include "base/memory_budget.hpp"
#include "formats/dataset/dataset_frame.hpp"
#include "scene/photographs.hpp"

namespace tureen {

struct TransformsDataset {
  std::vector<DatasetFrame> frames;  // in the file's order
  /// In the frames' coordinates, from the PLY file that `ply_file_path` names. Without that key,
  /// from a COLMAP model beside the file (colmap_folder()), mapped by `applied_transform`: the 3 x
  /// 4 matrix that Nerfstudio applied to COLMAP's world. Empty without both.
  std::vector<DatasetPoint> points;
  std::vector<Remark> remarks;
};

/// `images_folder` as in DatasetOptions: a leading "images/" in a name becomes
/// "images_4/". Throws InputError with the frame and the reason: no file_path, a lens that cannot
/// be undone (with its name), or a name outside of images/ if another folder is requested. A
/// missing PLY file is a remark.
TransformsDataset read_transforms_dataset(const std::filesystem::path& path, int images_folder,
                                          const MemoryBudget& budget = MemoryBudget());

}  // namespace tureen
