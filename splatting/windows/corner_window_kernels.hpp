// The hot loops of triangle windows with colours of their corners (SplatColor::per_corner), for the
// vectors of the processor, chosen at run time.
//
// With the homogeneous image points Q_k and N_k = Q_i x Q_j
// (splatting/windows/window_plane-inl.hpp), the barycentric of corner k at the image point p is w_k
// (N_k . p) / det: the distance from edge k over the inradius, times w_k |N_k.xy|, up to a common
// factor. A corner behind the eye has weight 0.
#pragma once

#include "splatting/windows/window_kernels.hpp"

namespace tureen::splatting {

/// Rows of projected windows with colours of corners, after those of projected_window_row, whose
/// red, green and blue are not used.
namespace projected_corner_row {
enum : std::size_t {
  weights = projected_window_row::count,  // max(w_k, 0) |N_k.xy|, relative to the largest
  red = weights + 3,                      // times the weights, >= 0
  green = red + 3,
  blue = green + 3,
  count = blue + 3
};
}

/// A projected window with colours of corners, as the compositing loop reads it.
struct alignas(16) CornerWindowEntry : WindowShape {
  float weights[3], red[3], green[3], blue[3];  // as projected_corner_row
};

/// See KernelFunctions.
struct CornerWindowKernel : KernelOf<TriangleWindows> {
  static constexpr const auto& shaders = WindowKernel::shaders;
  static constexpr const auto& texel_rows = WindowKernel::texel_rows;
  static constexpr std::size_t points = 3, colors = 3;
  using Entry = CornerWindowEntry;
  using Outline = WindowOutline;
  using Projected = ProjectedRows<projected_corner_row::count, projected_window_row::depth>;
  static const KernelFunctions<CornerWindowKernel>& functions();
  static void read(const Projected& projected, std::size_t i, Entry& entry, Outline& outline);
  static void list(const Entry&, const Outline& outline, std::uint32_t splat, TileLists& lists) {
    list_window(outline, splat, lists);
  }
};

}  // namespace tureen::splatting
