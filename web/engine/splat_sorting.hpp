// Sorting of splats in another instance of the engine, in a worker (web/viewer/splat_sorting.ts).
#pragma once

#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "runtime/splats/splat_sorter.hpp"

namespace tureen::web {

struct SortTask {
  std::vector<SplatsInView> views;
  bool sent = false;
  std::optional<SplatOrder> order;
};

struct SplatSorting {
  // in the page
  std::optional<SortTask> current;
  int number = 0;             // of the current task
  bool sent_centers = false;  // whether the worker has the centres of the current task
  // in the worker, of the last task
  std::vector<std::vector<glm::vec3>> centers;
  SplatOrder order;
};

/// A sorter whose tasks the command "sort_task" returns. Only one may exist at a time. Requires
/// SplatsInView::fraction 1, which tasks do not have.
std::unique_ptr<SplatSorter> make_page_sorter(SplatSorting& sorting);

}  // namespace tureen::web
