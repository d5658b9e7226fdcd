// The splats of a view, of kernels whose projection writes rows.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/thread_pool.hpp"
#include "splatting/image_view.hpp"
#include "splatting/parameter_rows.hpp"
#include "splatting/tiles/tile_lists.hpp"
#include "trainer/splats/tasks.hpp"

namespace tureen::trainer {

/// `Kernel` has the types Entry and Outline (a bound of the pixels), the constants `rows` and
/// `depth` (a row; NaN: not drawn), and the functions project, read and list of splatting/.
template <class Kernel>
class ProjectedRows {
 public:
  using Entry = typename Kernel::Entry;
  using Outline = typename Kernel::Outline;
  static constexpr std::size_t bytes_a_splat =
      sizeof(float) * Kernel::rows + sizeof(Entry) + sizeof(Outline);

  void project(ThreadPool& pool, const splatting::ImageView& view,
               const splatting::ParameterRows& drawn, int degree) {
    if (rows_.count() != drawn.count())
      rows_ = splatting::ParameterRows(Kernel::rows, drawn.count());
    // In memory order: in the order of blending, each of the rows would be a cache miss.
    entries_.resize(drawn.count());
    outlines_.resize(drawn.count());
    run_in_tasks(pool, drawn.count(), [&](std::size_t begin, std::size_t end) {
      Kernel::project(view, drawn, degree, begin, end, rows_);
      for (std::size_t i = begin; i < end; ++i)
        if (std::isfinite(depth(i))) Kernel::read(rows_, i, entries_[i], outlines_[i]);
    });
  }
  const std::vector<Entry>& entries() const { return entries_; }
  float depth(std::size_t i) const { return rows_.row(Kernel::depth)[i]; }
  void list(const splatting::ImageView&, std::uint32_t splat, splatting::TileLists& lists) const {
    Kernel::list(outlines_[splat], splat, lists);
  }
  /// The memory that list() reads.
  const void* listed(std::size_t i) const { return &outlines_[i]; }

 private:
  splatting::ParameterRows rows_;
  std::vector<Entry> entries_;
  std::vector<Outline> outlines_;
};

}  // namespace tureen::trainer
