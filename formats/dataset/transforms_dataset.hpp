// The photographs listed in a transforms.json, by paths relative to its folder.
#pragma once

#include <filesystem>
#include <vector>

#include "base/memory_budget.hpp"
#include "formats/dataset/dataset_points.hpp"
#include "formats/dataset/dataset_split.hpp"
#include "scene/photographs.hpp"

namespace tureen {

struct TransformsDataset {
  Frames frames;  // in the file's order, those of test_frames last
  /// train_filenames and so on, and the names of test_frames (ScanNet++).
  NamedSplit split;
  /// In the frames' coordinates: from the PLY file that `ply_file_path` names; without that key,
  /// from a COLMAP model beside the file, mapped by `applied_transform`, the 3 x 4 matrix that
  /// Nerfstudio applied to COLMAP's world, or from a PLY file beside it.
  FoundPoints points;
};

/// `images_folder` as in DatasetOptions: a leading "images/" in a name becomes "images_4/". A frame
/// has a defect if it has no file_path, a lens that cannot be undone, a bad number or pose, or a
/// name outside of images/ while another folder is requested. Throws InputError.
TransformsDataset read_transforms_dataset(const std::filesystem::path& path, int images_folder,
                                          const MemoryBudget& budget);

}  // namespace tureen
