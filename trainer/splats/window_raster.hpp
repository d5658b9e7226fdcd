// One view of triangle windows in training (trainer/splats/tile_raster.hpp).
#pragma once

#include "splatting/window_entries.hpp"
#include "trainer/splats/tile_raster.hpp"
#include "trainer/splats/window_step_kernels.hpp"

namespace tureen::trainer {

struct WindowMethod {
  using Parameters = WindowParameters;
  using Entry = splatting::WindowEntry;
  using Outline = splatting::WindowOutline;
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
  /// Of a drawn splat.
  static void read(const splatting::ParameterRows& projected, std::size_t splat, Entry& entry,
                   Outline& outline) {
    splatting::read_entry(projected, splat, entry, outline);
  }
  static void list(const splatting::ImageView&, const Entry&, const Outline& outline,
                   std::uint32_t splat, splatting::TileLists& lists) {
    splatting::list_window(outline, splat, lists);
  }
  static constexpr auto blend_recorded = &blend_windows_recorded;
  static constexpr auto blend_backward = &blend_windows_backward;
};

using WindowRaster = TileRaster<WindowMethod>;

}  // namespace tureen::trainer
