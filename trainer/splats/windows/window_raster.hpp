// One view of triangle windows in training (trainer/splats/tile_raster.hpp).
#pragma once

#include "splatting/windows/window_entries.hpp"
#include "trainer/splats/projected_rows.hpp"
#include "trainer/splats/tile_raster.hpp"
#include "trainer/splats/windows/window_step_kernels.hpp"

namespace tureen::trainer {

struct WindowProjection {
  using Entry = splatting::WindowEntry;
  using Outline = splatting::WindowOutline;
  static constexpr std::size_t rows = splatting::projected_window_row::count;
  static constexpr std::size_t depth = splatting::projected_window_row::depth;
  static constexpr auto project = &splatting::project_windows;
  static constexpr auto read = &splatting::read_entry;
  static constexpr auto list = &splatting::list_window;
};

struct WindowMethod {
  using Parameters = WindowParameters;
  using Projected = ProjectedRows<WindowProjection>;
  using Moments = WindowMoments;
  using BackwardInput = WindowBackwardInput;
  static constexpr std::string_view profile = "triangle-splatting";
  static constexpr bool has_variance = true;
  static constexpr auto blend_recorded = &blend_windows_recorded;
  static constexpr auto blend_backward = &blend_windows_backward;
};

using WindowRaster = TileRaster<WindowMethod>;

}  // namespace tureen::trainer
