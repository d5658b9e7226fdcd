// Long work in several threads, with progress and cancellation.
#pragma once

#include <cstddef>
#include <functional>

namespace tureen {

/// Runs `work(i, check)` for 0 .. count - 1 on all cores. The work calls `check` regularly, with
/// any argument; it throws to stop the work. The calling thread passes the fraction done to
/// `progress`, at once and then ten times per second. Exceptions from `progress` or from the work
/// end the work and are rethrown.
void on_all_cores(
    std::size_t count, const std::function<void(double)>& progress,
    const std::function<void(std::size_t i, const std::function<void(double)>& check)>& work);

}  // namespace tureen
