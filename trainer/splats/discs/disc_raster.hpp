// One view of discs in training (trainer/splats/tile_raster.hpp).
#pragma once

#include "splatting/discs/disc_entries.hpp"
#include "trainer/splats/discs/disc_step_kernels.hpp"
#include "trainer/splats/projected_rows.hpp"
#include "trainer/splats/tile_raster.hpp"

namespace tureen::trainer {

struct DiscProjection {
  using Entry = splatting::DiscEntry;
  using Outline = splatting::Box;
  static constexpr std::size_t rows = splatting::projected_disc_row::count;
  static constexpr std::size_t depth = splatting::projected_disc_row::depth;
  static constexpr auto project = &splatting::project_discs;
  static void read(const splatting::ParameterRows& projected, std::size_t i, Entry& entry,
                   Outline& outline) {
    entry = splatting::disc_entry(projected, i);
    outline = splatting::disc_box(projected, i);
  }
  static void list(const Outline& box, std::uint32_t splat, splatting::TileLists& lists) {
    lists.add(box, splat);
  }
};

struct DiscMethod {
  using Parameters = GaussianParameters;
  using Projected = ProjectedRows<DiscProjection>;
  using Moments = DiscMoments;
  using BackwardInput = DiscBackwardInput;
  static constexpr std::string_view profile = "2dgs";
  static constexpr auto blend_recorded = &blend_discs_recorded;
  static constexpr auto blend_backward = &blend_discs_backward;
};

using DiscRaster = TileRaster<DiscMethod>;

}  // namespace tureen::trainer
