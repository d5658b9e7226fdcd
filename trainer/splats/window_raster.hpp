// One view of triangle windows in training (trainer/splats/tile_raster.hpp).
#pragma once

#include "splatting/window_entries.hpp"
#include "trainer/splats/tile_raster.hpp"
#include "trainer/splats/window_step_kernels.hpp"

namespace tureen::trainer {

struct WindowMethod {
  using Parameters = WindowParameters;
  using Entry = splatting::WindowEntry;
  using Moments = WindowMoments;
  using Scratch = WindowScratch;
  using BackwardInput = WindowBackwardInput;
  static constexpr std::string_view profile = "triangle-splatting";
  static constexpr std::size_t projected_rows = splatting::projected_window_row::count;
  static constexpr std::size_t depth_row = splatting::projected_window_row::depth;

  static void project(const splatting::ImageView& view, const splatting::ParameterRows& drawn,
                      int degree, splatting::ParameterRows& projected) {
    splatting::project_windows(view, drawn, degree, projected);
  }
  /// Reads the entry of a drawn splat, and adds it to its tiles as `place`.
  static void list(const splatting::ImageView&, const splatting::ParameterRows& projected,
                   std::size_t splat, std::uint32_t place, Entry& entry,
                   splatting::TileLists& lists) {
    splatting::WindowOutline outline;
    splatting::read_entry(projected, splat, entry, outline);
    splatting::list_window(outline, place, lists);
  }
  static constexpr auto blend_recorded = &blend_windows_recorded;
  static constexpr auto blend_backward = &blend_windows_backward;
};

using WindowRaster = TileRaster<WindowMethod>;

}  // namespace tureen::trainer
