// What the tile renderer and the training call of each kernel of splats.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "scene/splats.hpp"
#include "splatting/image_view.hpp"
#include "splatting/parameter_rows.hpp"
#include "splatting/tiles/tile_lists.hpp"

namespace tureen::splatting {

struct TileHits;

/// In Kernel::texel_rows: a value that is 0 for all splats.
inline constexpr std::size_t no_row = ~std::size_t(0);

/// The hot loops of a kernel, for the vectors of the processor, chosen at run time. `Kernel` is a
/// struct of
///   Entry        a projected splat, as the blending loop reads it
///   Outline      bounds the pixels of an entry
///   Projected    the results of `project`, for a number of splats: ProjectedRows or entries
///   functions()  these functions
///   read(projected, i, entry, outline)    sets the entry and the outline of splat `i`, which is
///                drawn
///   list(entry, outline, splat, lists)    adds `splat` to all tiles where alpha reaches the
///                smallest at a pixel centre, and to few others
///   shaders      the name of its shaders (runtime/splats/device_splats.cpp)
///   texel_rows   the layout of a splat's texels on the device: the row of each component
/// and the members of KernelOf.
template <class Kernel>
struct KernelFunctions {
  using Entry = typename Kernel::Entry;

  /// Projects the splats [begin, end), with `begin` a multiple of row_alignment. `rows` has the
  /// kernel's rows, with harmonics up to `degree`; `projected` is for as many splats.
  void (*project)(const ImageView& view, const ParameterRows& rows, int degree, std::size_t begin,
                  std::size_t end, typename Kernel::Projected& projected);
  /// Blends the entries front to back into the pixels of a tile.
  void (*blend)(const ImageView& view, std::span<const Entry> entries,
                std::span<const std::uint32_t> tile, TilePixels& pixels);
  /// Adds the entries to the hits of a tile (Layer::collect). The entry at place i is that of the
  /// splat order[i] in `rows`.
  void (*collect)(const ImageView& view, const ParameterRows& rows,
                  std::span<const std::uint32_t> order, std::span<const Entry> entries,
                  std::span<const std::uint32_t> tile, const TilePixels& pixels, TileHits& hits);
};

/// What a kernel draws: splats of a kernel of scene/kernels/, by profiles with this projection.
template <class SceneKernel>
struct KernelOf {
  using Of = SceneKernel;
  static constexpr auto projection = SplatProfile::Projection::ewa;
  static constexpr std::size_t points = 1;  // whose mean is the centre; they are the first rows
  static constexpr std::size_t colors = 1;
};

/// Kernel::Projected of `row_count` rows. `depth_row` has the view depth of each centre in layer
/// units; NaN: not drawn.
template <std::size_t row_count, std::size_t depth_row>
struct ProjectedRows : ParameterRows {
  static constexpr std::size_t bytes_a_splat = row_count * sizeof(float);

  explicit ProjectedRows(std::size_t count = 0) : ParameterRows(row_count, count) {}
  std::span<const float> depths() const { return {row(depth_row), count()}; }
};

}  // namespace tureen::splatting
