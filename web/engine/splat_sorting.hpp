// Sorting of splats in another instance of the engine, in a worker (web/viewer/splat_sorting.ts).
#pragma once

#include <memory>

#include "runtime/splats/splat_sorter.hpp"
#include "web/engine/commands.hpp"

namespace tureen::web {

/// A sorter whose tasks the command "sort_task" returns. Only one may exist at a time.
/// Requires SplatsInView::fraction 1, which tasks do not have.
std::unique_ptr<SplatSorter> make_page_sorter();

/// Commands of both instances.
Commands sorting_commands();

}  // namespace tureen::web
