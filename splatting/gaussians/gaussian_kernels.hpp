// The hot loops of Gaussians by EWA splatting (3DGS, arXiv 2308.04079; Mip-Splatting, arXiv
// 2311.16493), for the vectors of the processor, chosen at run time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "splatting/image_view.hpp"
#include "splatting/layer.hpp"
#include "splatting/parameter_rows.hpp"
#include "splatting/tiles/tile_lists.hpp"

namespace tureen::splatting {

/// Rows of Gaussians. Values are after activation. Harmonics follow: red, green and blue of each
/// coefficient.
namespace gaussian_row {
enum : std::size_t {
  x,
  y,
  z,  // the centre, in layer coordinates
  scale_x,
  scale_y,
  scale_z,  // standard deviations, >= 0; z is 0 for flat ones
  rotation_x,
  rotation_y,
  rotation_z,
  rotation_w,  // of unit length
  opacity,
  harmonics
};
}

/// A projected Gaussian, with its centre at (x, y) in pixels. At an offset (dx, dy) from it,
/// log2(alpha) = log_opacity - (p dx + q dy)^2 - (r dy)^2.
struct alignas(64) GaussianEntry {
  float x, y, p, q, r, log_opacity;
  float red, green, blue;         // >= 0
  float inverse_depth, depth;     // of the centre; a NaN depth: not drawn
  float half_width, half_height;  // in pixels, of the ellipse where alpha is the smallest
};

/// Projects as many splats as there are entries, from `begin` on, a multiple of row_alignment.
void project_gaussians(const ImageView& view, const ParameterRows& gaussians, int harmonics_degree,
                       std::size_t begin, std::span<GaussianEntry> entries);

/// Blends the entries front to back into the pixels of a tile.
void blend_gaussians(const ImageView& view, std::span<const GaussianEntry> entries,
                     std::span<const std::uint32_t> tile, TilePixels& pixels);

/// A Gaussian in view coordinates, for the depth at which a ray meets its largest density: the
/// unit axes, each times the smallest scale over its own, and the centre, in layer units.
struct GaussianPeak {
  float axes[9], center[3];
};
/// Of Gaussian `i` in rows of gaussian_row.
GaussianPeak gaussian_peak(const ImageView& view, const ParameterRows& gaussians, std::size_t i);

/// Adds the entries to the hits of a tile (Layer::collect). The Gaussian at place i of the entries
/// is order[i] in the rows.
void collect_gaussians(const ImageView& view, std::span<const GaussianEntry> entries,
                       const ParameterRows& gaussians, std::span<const std::uint32_t> order,
                       std::span<const std::uint32_t> tile, const TilePixels& pixels,
                       TileHits& hits);

/// The name of the chosen vectors: "AVX3_ZEN4", "AVX2", ..
const char* vector_target();

}  // namespace tureen::splatting
