// The hot loops of Gaussians by EWA splatting (3DGS, arXiv 2308.04079; Mip-Splatting, arXiv
// 2311.16493), for the vectors of the processor, chosen at run time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "splatting/kernel.hpp"

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
  float inverse_depth;            // of the centre
  float limit;                    // log_opacity minus the logarithm of the smallest alpha
  float half_width, half_height;  // in pixels, of the ellipse where alpha is the smallest
};

/// Entries, because each row would be a cache miss in the order of blending.
struct ProjectedGaussians {
  static constexpr std::size_t bytes_a_splat = sizeof(GaussianEntry) + sizeof(float);

  std::vector<GaussianEntry> entries;
  std::vector<float> depth;

  explicit ProjectedGaussians(std::size_t count = 0) : entries(count), depth(count) {}
  std::size_t count() const { return entries.size(); }
  std::span<const float> depths() const { return depth; }
};

/// See KernelFunctions.
struct GaussianKernel : KernelOf<Gaussians> {
  static constexpr const char shaders[] = "gaussians";
  /// The centre with the opacity, the scales, the rotation.
  static constexpr std::size_t texel_rows[] = {0, 1, 2, gaussian_row::opacity, 3, 4, 5, no_row, 6,
                                               7, 8, 9};
  using Entry = GaussianEntry;
  struct Outline {};  // the entry has it
  using Projected = ProjectedGaussians;
  static const KernelFunctions<GaussianKernel>& functions();
  static void read(const Projected& projected, std::size_t i, Entry& entry, Outline&) {
    entry = projected.entries[i];
  }
  static void list(const Entry& entry, const Outline&, std::uint32_t splat, TileLists& lists);
};

/// A Gaussian in view coordinates, for the depth at which a ray meets its largest density: the
/// unit axes, each times the smallest scale over its own, and the centre, in layer units.
struct GaussianPeak {
  float axes[9], center[3];
};
/// Of Gaussian `i` in rows of gaussian_row.
GaussianPeak gaussian_peak(const ImageView& view, const ParameterRows& gaussians, std::size_t i);

}  // namespace tureen::splatting
