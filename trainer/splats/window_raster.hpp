// One view of triangle windows in training (trainer/splats/tile_raster.hpp).
#pragma once

#include "splatting/window_entries.hpp"
#include "trainer/splats/tile_raster.hpp"
#include "trainer/splats/window_step_kernels.hpp"

namespace tureen::trainer {

/// The splats of a view.
class ProjectedWindows {
 public:
  static constexpr std::size_t bytes_a_splat =
      sizeof(float) * splatting::projected_window_row::count + sizeof(splatting::WindowEntry) +
      sizeof(splatting::WindowOutline);

  void project(ThreadPool& pool, const splatting::ImageView& view,
               const splatting::ParameterRows& drawn, int degree) {
    if (rows_.count() != drawn.count())
      rows_ = splatting::ParameterRows(splatting::projected_window_row::count, drawn.count());
    // In memory order: in the order of blending, each of the rows would be a cache miss.
    entries_.resize(drawn.count());
    outlines_.resize(drawn.count());
    run_in_tasks(pool, drawn.count(), [&](std::size_t begin, std::size_t end) {
      splatting::project_windows(view, drawn, degree, begin, end, rows_);
      for (std::size_t i = begin; i < end; ++i)
        if (std::isfinite(depth(i))) splatting::read_entry(rows_, i, entries_[i], outlines_[i]);
    });
  }
  const std::vector<splatting::WindowEntry>& entries() const { return entries_; }
  /// NaN: not drawn.
  float depth(std::size_t i) const { return rows_.row(splatting::projected_window_row::depth)[i]; }
  void list(const splatting::ImageView&, std::uint32_t splat, splatting::TileLists& lists) const {
    splatting::list_window(outlines_[splat], splat, lists);
  }

 private:
  splatting::ParameterRows rows_;
  std::vector<splatting::WindowEntry> entries_;
  std::vector<splatting::WindowOutline> outlines_;
};

struct WindowMethod {
  using Parameters = WindowParameters;
  using Moments = WindowMoments;
  using BackwardInput = WindowBackwardInput;
  static constexpr std::string_view profile = "triangle-splatting";
  using Projected = ProjectedWindows;
  static constexpr bool has_variance = true;
  static constexpr auto blend_recorded = &blend_windows_recorded;
  static constexpr auto blend_backward = &blend_windows_backward;
};

using WindowRaster = TileRaster<WindowMethod>;

}  // namespace tureen::trainer
