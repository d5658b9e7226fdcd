// The hot loops of neural densities (Splat the Net, arXiv 2510.08491), for the vectors of the
// processor, chosen at run time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "splatting/ellipse.hpp"
#include "splatting/kernel.hpp"

namespace tureen::splatting {

inline constexpr std::size_t neurons = NeuralDensities::width;

/// Rows of neural densities. Harmonics follow: red, green and blue of each coefficient.
namespace neural_row {
enum : std::size_t {
  center,                              // x, y, z, in layer coordinates
  semi_axes = center + 3,              // > 0
  rotation = semi_axes + 3,            // x, y, z, w, of unit length
  frequencies = rotation + 4,          // x, y, z of each neuron, times omega
  phases = frequencies + 3 * neurons,  // times omega
  amplitudes = phases + neurons,
  offset = amplitudes + neurons,  // b2
  harmonics
};
}

/// The centre, the semi-axes with the offset, the rotation; then the frequencies of each neuron
/// with its phase, and the amplitudes.
inline constexpr auto neural_texel_rows = [] {
  namespace row = neural_row;
  std::array<std::size_t, 12 + 5 * neurons> rows{0, 1, 2, no_row, 3, 4, 5, row::offset, 6, 7, 8, 9};
  for (std::size_t k = 0; k < 4 * neurons; ++k)
    rows[12 + k] = k % 4 < 3 ? row::frequencies + k / 4 * 3 + k % 4 : row::phases + k / 4;
  for (std::size_t k = 0; k < neurons; ++k) rows[12 + 4 * neurons + k] = row::amplitudes + k;
  return rows;
}();

/// Rows of projected neural densities: the members of NeuralEntry, and more.
namespace projected_neural_row {
enum : std::size_t {
  center,
  sphere_from_view = center + 3,
  by_unit = sphere_from_view + 9,
  near,
  twice_by_largest,
  offset,
  frequencies,
  phases = frequencies + 3 * neurons,
  amplitudes = phases + neurons,
  red = amplitudes + neurons,
  green,
  blue,
  depth,    // of the centre, in layer units; NaN: not drawn
  outline,  // x, y, p, q, r, half_width and half_height of an Ellipse with the limit 1 around the
            // image; x is NaN if it may cover any pixel
  count = outline + 7
};
}

/// A projected neural density, as the compositing loop reads it. Lengths are in the splat's own
/// unit, the power of 2 at or below the largest semi-axis; vectors are in view coordinates. Each
/// cache line has what is used at the same time; arrays of neurons are aligned as vectors.
struct alignas(64) NeuralEntry {
  float outline[5];  // x, y, p, q and r of the Ellipse with the limit 1
  float center[3];
  float phases[neurons];
  float sphere_from_view[9];  // row by row; the ellipsoid becomes the unit sphere
  float by_unit;              // one over the unit, in layer units
  float near;                 // the depth of the near plane
  float twice_by_largest;     // 2 over the largest semi-axis
  float offset;
  float red, green, blue;  // >= 0
  // Over the largest semi-axis: x of all neurons, then y and z.
  float frequencies[3 * neurons];
  float amplitudes[neurons];
};

/// See KernelFunctions. x of an outline is NaN if the splat may cover any pixel.
struct NeuralKernel : KernelOf<NeuralDensities> {
  static constexpr const char shaders[] = "neural";
  static constexpr const auto& texel_rows = neural_texel_rows;
  using Entry = NeuralEntry;
  using Outline = Ellipse;
  using Projected = ProjectedRows<projected_neural_row::count, projected_neural_row::depth>;
  static const KernelFunctions<NeuralKernel>& functions();
  static void read(const Projected& projected, std::size_t i, Entry& entry, Outline& outline);
  static void list(const Entry&, const Outline& outline, std::uint32_t splat, TileLists& lists);
};

}  // namespace tureen::splatting
