// Where a dataset keeps the points from which a training starts.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/memory_budget.hpp"
#include "formats/dataset/colmap.hpp"
#include "scene/photographs.hpp"

namespace tureen {

struct FoundPoints {
  std::vector<DatasetPoint> points = {};
  std::vector<Remark> remarks = {};
};

/// The points in a PLY file. One that is missing or cannot be read is a remark; `name`: of the file
/// in remarks. Throws InputError for the memory.
FoundPoints points_of_ply(const std::filesystem::path& file, const std::string& name,
                          const MemoryBudget& budget);

/// The first of points3D.ply and points3d.ply in `folder`; without them, no points and no remark.
FoundPoints points_beside(const std::filesystem::path& folder, const MemoryBudget& budget);

/// The points of a COLMAP model, otherwise those beside it. Throws InputError.
FoundPoints points_of_model(const std::filesystem::path& model, const MemoryBudget& budget);

}  // namespace tureen
