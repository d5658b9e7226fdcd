// The splats of a view in training.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/threads/thread_pool.hpp"
#include "splatting/kernel.hpp"
#include "trainer/splats/tasks.hpp"

namespace tureen::trainer {

/// `Kernel`: see splatting::KernelFunctions.
template <class Kernel>
class ProjectedSplats {
 public:
  using Entry = typename Kernel::Entry;
  using Outline = typename Kernel::Outline;
  using Projected = typename Kernel::Projected;
  /// Whether the projection makes the entries, which have their outlines.
  static constexpr bool makes_entries = requires(Projected projected) { projected.entries; };
  static constexpr std::size_t bytes_a_splat =
      Projected::bytes_a_splat + (makes_entries ? 0 : sizeof(Entry) + sizeof(Outline));

  void project(ThreadPool& pool, const splatting::ImageView& view,
               const splatting::ParameterRows& drawn, int degree) {
    if (projected_.count() != drawn.count()) projected_ = Projected(drawn.count());
    outlines_.resize(drawn.count());
    if constexpr (!makes_entries) entries_.resize(drawn.count());
    run_in_tasks(pool, drawn.count(), [&](std::size_t begin, std::size_t end) {
      Kernel::functions().project(view, drawn, degree, begin, end, projected_);
      // In memory order: in the order of blending, each of the rows would be a cache miss.
      if constexpr (!makes_entries)
        for (std::size_t i = begin; i < end; ++i)
          if (std::isfinite(depth(i))) Kernel::read(projected_, i, entries_[i], outlines_[i]);
    });
  }
  const std::vector<Entry>& entries() const {
    if constexpr (makes_entries)
      return projected_.entries;
    else
      return entries_;
  }
  /// NaN: not drawn.
  float depth(std::size_t i) const { return projected_.depths()[i]; }
  void list(std::uint32_t splat, splatting::TileLists& lists) const {
    Kernel::list(entries()[splat], outlines_[splat], splat, lists);
  }
  /// The memory that list() reads.
  const void* listed(std::size_t i) const {
    if constexpr (makes_entries)
      return &projected_.entries[i];
    else
      return &outlines_[i];
  }

 private:
  Projected projected_;
  std::vector<Entry> entries_;  // unless the projection makes them
  std::vector<Outline> outlines_;
};

}  // namespace tureen::trainer
