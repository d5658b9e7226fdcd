// The hot loops of discs on their planes (2DGS, arXiv 2403.17888; REdiSplats, arXiv 2503.12284),
// for the vectors of the processor, chosen at run time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "splatting/gaussians/gaussian_kernels.hpp"
#include "splatting/kernel.hpp"

namespace tureen::splatting {

/// Rows of projected discs. A point (u, v) of the disc, in standard deviations, has the homogeneous
/// image point u H_u + v H_v + H_c, in pixels from an origin. If the centre is in front of the near
/// plane, the origin is its image; then H_c = (0, 0, depth).
namespace projected_disc_row {
enum : std::size_t {
  x,
  y,  // the origin
  u_x,
  v_x,
  c_x,
  u_y,
  v_y,
  c_y,
  u_w,
  v_w,
  c_w,
  log_opacity,
  red,
  green,
  blue,   // >= 0
  depth,  // of the centre; NaN: not drawn
  left,
  right,
  top,
  bottom,  // of the box outside of which alpha is below the smallest
  count
};
}

/// A projected disc, as the compositing loop reads it.
struct alignas(64) DiscEntry {
  float x, y, u_x, v_x, c_x, u_y, v_y, c_y, u_w, v_w, c_w, log_opacity, red, green, blue;
};

/// See KernelFunctions. The rows are those of gaussian_row.
struct DiscKernel : KernelOf<Gaussians> {
  static constexpr const char shaders[] = "discs";
  static constexpr const auto& texel_rows = GaussianKernel::texel_rows;
  static constexpr auto projection = SplatProfile::Projection::plane;
  using Entry = DiscEntry;
  using Outline = Box;
  using Projected = ProjectedRows<projected_disc_row::count, projected_disc_row::depth>;
  static const KernelFunctions<DiscKernel>& functions();
  static void read(const Projected& projected, std::size_t i, Entry& entry, Outline& outline);
  static void list(const Entry&, const Outline& outline, std::uint32_t splat, TileLists& lists) {
    lists.add(outline, splat);
  }
};

}  // namespace tureen::splatting
