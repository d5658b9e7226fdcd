#include "formats/dataset/dataset_points.hpp"

#include "base/error.hpp"
#include "base/input.hpp"
#include "formats/dataset/dataset_remarks.hpp"
#include "formats/dataset/points_ply.hpp"

namespace tureen {

namespace {

void count_skipped(std::size_t skipped, std::vector<Remark>& list) {
  if (skipped > 0) list.push_back({&remarks::points_skipped, {{"count", std::uint64_t(skipped)}}});
}

Remark unreadable(const std::string& file, const InputError& error) {
  return {&remarks::points_unreadable, {{"file", file}, {"reason", error.reason()}}};
}

}  // namespace

FoundPoints points_of_ply(const std::filesystem::path& file, const std::string& name,
                          const MemoryBudget& budget) {
  FoundPoints found;
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) {
    found.remarks.push_back({&remarks::points_missing, {{"file", name}}});
    return found;
  }
  try {
    Input input = Input::open(file, budget);
    PointsPly read = read_points_ply(input);
    found.points = std::move(read.points);
    count_skipped(read.skipped, found.remarks);
  } catch (const InputError& error) {
    if (is_about_memory(error)) throw;
    found.remarks.push_back(unreadable(name, error));
  }
  return found;
}

FoundPoints points_beside(const std::filesystem::path& folder, const MemoryBudget& budget) {
  for (const char* name : {"points3D.ply", "points3d.ply"}) {
    std::error_code ignored;
    if (std::filesystem::is_regular_file(folder / name, ignored))
      return points_of_ply(folder / name, name, budget);
  }
  return {};
}

FoundPoints points_of_model(const std::filesystem::path& model, const MemoryBudget& budget) {
  ColmapPoints read;
  try {
    read = read_colmap_points(model, budget);
  } catch (const InputError& error) {
    if (is_about_memory(error)) throw;
    FoundPoints found = points_beside(model, budget);
    found.remarks.push_back(unreadable(model.filename().string() + "/points3D", error));
    return found;
  }
  if (read.points.empty() && read.skipped == 0) return points_beside(model, budget);
  FoundPoints found{.points = std::move(read.points)};
  count_skipped(read.skipped, found.remarks);
  return found;
}

}  // namespace tureen
