// The hot loops of triangle windows (Triangle Splatting, arXiv 2505.19175), for the vectors of the
// processor, chosen at run time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "splatting/kernel.hpp"

namespace tureen::splatting {

/// Rows of windows. Harmonics follow: red, green and blue of each coefficient; with colours of
/// corners, those of the first corner, the second and the third.
namespace window_row {
enum : std::size_t {
  corners,  // x, y, z of each of the three, in layer coordinates
  sigma = corners + 9,
  opacity,
  harmonics
};
}

/// Rows of projected windows. At an offset (dx, dy) from (x, y), in pixels, the distance from edge
/// k over the inradius is edges[3 k] dx + edges[3 k + 1] dy + edges[3 k + 2], and one over the
/// depth likewise. With ImageView::solidity, the edges are those of rho_s instead.
namespace projected_window_row {
enum : std::size_t {
  x,
  y,
  edges,
  inverse_depth = edges + 9,
  sigma = inverse_depth + 3,
  log_opacity,
  min_rho,  // where alpha is the smallest
  red,
  green,
  blue,   // >= 0
  depth,  // of the centre; NaN: not drawn
  // Corners of the triangle where rho is min_rho: x and y. NaN: it reaches the near plane.
  outline,
  count = outline + 6
};
}

/// What the alpha of a projected window depends on, as projected_window_row.
struct WindowShape {
  float x, y, edges[9], inverse_depth[3], sigma, log_opacity, min_rho;
};

/// A projected window, as the compositing loop reads it.
struct alignas(16) WindowEntry : WindowShape {
  float red, green, blue;
  bool reaches_near;  // some part may be nearer than the near plane
};

/// projected_window_row::outline.
using WindowOutline = std::array<float, 6>;

/// Adds `splat` to all tiles with a pixel centre in the outline, and to few others.
void list_window(const WindowOutline& outline, std::uint32_t splat, TileLists& lists);

/// See KernelFunctions.
struct WindowKernel : KernelOf<TriangleWindows> {
  static constexpr const char shaders[] = "windows";
  static constexpr std::size_t points = 3;
  /// Each texel has a corner.
  static constexpr std::size_t texel_rows[] = {
      0, 1, 2, window_row::sigma, 3, 4, 5, window_row::opacity, 6, 7, 8, no_row};
  using Entry = WindowEntry;
  using Outline = WindowOutline;
  using Projected = ProjectedRows<projected_window_row::count, projected_window_row::depth>;
  static const KernelFunctions<WindowKernel>& functions();
  static void read(const Projected& projected, std::size_t i, Entry& entry, Outline& outline);
  static void list(const Entry&, const Outline& outline, std::uint32_t splat, TileLists& lists) {
    list_window(outline, splat, lists);
  }
};

}  // namespace tureen::splatting
