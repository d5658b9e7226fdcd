// One view of Gaussians in training (trainer/splats/tile_raster.hpp).
#pragma once

#include "splatting/gaussians/gaussian_entries.hpp"
#include "trainer/splats/gaussians/gaussian_step_kernels.hpp"
#include "trainer/splats/tile_raster.hpp"

namespace tureen::trainer {

/// The splats of a view.
class ProjectedGaussians {
 public:
  static constexpr std::size_t bytes_a_splat = sizeof(splatting::GaussianEntry);

  void project(ThreadPool& pool, const splatting::ImageView& view,
               const splatting::ParameterRows& drawn, int degree) {
    entries_.resize(drawn.count());
    run_in_tasks(pool, drawn.count(), [&](std::size_t begin, std::size_t end) {
      splatting::project_gaussians(view, drawn, degree, begin,
                                   std::span(entries_).subspan(begin, end - begin));
    });
  }
  const std::vector<splatting::GaussianEntry>& entries() const { return entries_; }
  /// NaN: not drawn.
  float depth(std::size_t i) const { return entries_[i].depth; }
  void list(const splatting::ImageView& view, std::uint32_t splat,
            splatting::TileLists& lists) const {
    splatting::list_gaussian(entries_[splat], std::log2(view.min_alpha), splat, lists);
  }
  /// The memory that list() reads.
  const void* listed(std::size_t i) const { return &entries_[i]; }

 private:
  std::vector<splatting::GaussianEntry> entries_;
};

struct GaussianMethod {
  using Parameters = GaussianParameters;
  using Projected = ProjectedGaussians;
  using Moments = GaussianMoments;
  using BackwardInput = GaussianBackwardInput;
  static constexpr std::string_view profile = "3dgs";
  static constexpr auto blend_recorded = &blend_gaussians_recorded;
  static constexpr auto blend_backward = &blend_gaussians_backward;
};

using GaussianRaster = TileRaster<GaussianMethod>;

}  // namespace tureen::trainer
