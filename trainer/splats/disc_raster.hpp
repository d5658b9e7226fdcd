// One view of discs in training (trainer/splats/tile_raster.hpp).
#pragma once

#include "splatting/disc_entries.hpp"
#include "trainer/splats/disc_step_kernels.hpp"
#include "trainer/splats/tile_raster.hpp"

namespace tureen::trainer {

/// The splats of a view.
class ProjectedDiscs {
 public:
  static constexpr std::size_t bytes_a_splat =
      sizeof(float) * splatting::projected_disc_row::count + sizeof(splatting::DiscEntry) +
      sizeof(splatting::Box);

  void project(ThreadPool& pool, const splatting::ImageView& view,
               const splatting::ParameterRows& drawn, int degree) {
    if (rows_.count() != drawn.count())
      rows_ = splatting::ParameterRows(splatting::projected_disc_row::count, drawn.count());
    // In memory order: in the order of blending, each of the rows would be a cache miss.
    entries_.resize(drawn.count());
    boxes_.resize(drawn.count());
    run_in_tasks(pool, drawn.count(), [&](std::size_t begin, std::size_t end) {
      splatting::project_discs(view, drawn, degree, begin, end, rows_);
      for (std::size_t i = begin; i < end; ++i) {
        if (!std::isfinite(depth(i))) continue;
        entries_[i] = splatting::disc_entry(rows_, i);
        boxes_[i] = splatting::disc_box(rows_, i);
      }
    });
  }
  const std::vector<splatting::DiscEntry>& entries() const { return entries_; }
  /// NaN: not drawn.
  float depth(std::size_t i) const { return rows_.row(splatting::projected_disc_row::depth)[i]; }
  void list(const splatting::ImageView&, std::uint32_t splat, splatting::TileLists& lists) const {
    lists.add(boxes_[splat], splat);
  }

 private:
  splatting::ParameterRows rows_;
  std::vector<splatting::DiscEntry> entries_;
  std::vector<splatting::Box> boxes_;
};

struct DiscMethod {
  using Parameters = GaussianParameters;
  using Projected = ProjectedDiscs;
  using Moments = DiscMoments;
  using BackwardInput = DiscBackwardInput;
  static constexpr std::string_view profile = "2dgs";
  static constexpr auto blend_recorded = &blend_discs_recorded;
  static constexpr auto blend_backward = &blend_discs_backward;
};

using DiscRaster = TileRaster<DiscMethod>;

}  // namespace tureen::trainer
