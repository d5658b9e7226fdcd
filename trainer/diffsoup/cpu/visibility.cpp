#include "trainer/diffsoup/cpu/visibility.hpp"

#include <algorithm>

#include "scene/lattice.hpp"
#include "trainer/common/cpu/vector_clones.hpp"
#include "trainer/common/kernels/random.hpp"

namespace tureen::trainer {

namespace {

/// Calls visit(tile) for all tiles that the face's rectangle meets.
template <class Visitor>
void for_each_tile(const BatchImage& image, const kernels::ProjectedFace& face, Visitor&& visit) {
  if (face.empty()) return;
  for (int y = face.y0 / tile_side; y <= (face.y1 - 1) / tile_side; ++y)
    for (int x = face.x0 / tile_side; x <= (face.x1 - 1) / tile_side; ++x)
      visit(std::size_t(y) * std::size_t(image.tiles_x) + std::size_t(x));
}

}  // namespace

void bin_faces(BatchImage& image, const Model& model) {
  const std::size_t faces = model.faces();
  image.projected.resize(faces);
  image.bin_begin.assign(std::size_t(image.tiles_x) * image.tiles_y + 1, 0);
  for (std::size_t face = 0; face < faces; ++face) {
    image.projected[face] = kernels::project(image.view, &model.positions[3 * face].x);
    for_each_tile(image, image.projected[face],
                  [&](std::size_t tile) { ++image.bin_begin[tile + 1]; });
  }
  for (std::size_t tile = 1; tile < image.bin_begin.size(); ++tile)
    image.bin_begin[tile] += image.bin_begin[tile - 1];
  image.bins.resize(image.bin_begin.back());
  std::vector<std::uint32_t> next(image.bin_begin.begin(), image.bin_begin.end() - 1);
  for (std::size_t face = 0; face < faces; ++face)
    for_each_tile(image, image.projected[face],
                  [&](std::size_t tile) { image.bins[next[tile]++] = std::uint32_t(face); });
}

TUREEN_VECTOR_CLONES TUREEN_FLATTEN std::uint64_t find_visible(BatchImage& image, std::size_t tile,
                                                               const float* alpha, int level,
                                                               Masking masking) {
  const kernels::Rectangle within = image.tile(tile);
  const std::size_t width = std::size_t(image.view.width);
  for (int y = within.y0; y < within.y1; ++y)
    std::fill_n(image.visible.begin() + std::ptrdiff_t(std::size_t(y) * width) + within.x0,
                within.x1 - within.x0, VisiblePixel{});
  std::uint64_t fragments = 0;
  const std::size_t texels = lattice::texel_count(level);
  for (std::uint32_t i = image.bin_begin[tile]; i < image.bin_begin[tile + 1]; ++i) {
    const std::uint32_t face = image.bins[i];
    const float* texture = alpha + face * texels;
    kernels::for_each_fragment(
        image.view, image.projected[face],
        within, [&](const kernels::Fragment& fragment) __attribute__((always_inline)) {
          ++fragments;
          const std::size_t pixel = std::size_t(fragment.y) * width + std::size_t(fragment.x);
          VisiblePixel& visible = image.visible[pixel];
          if (fragment.inverse_depth <= visible.inverse_depth) return;
          const auto at = lattice::footprint(level, fragment.b0, fragment.b1);
          const float a = lattice::interpolated(at, texture);
          const float needed =
              masking == Masking::threshold
                  ? alpha_threshold
                  : kernels::uniform_draw(image.draw_key, std::uint32_t(pixel), face);
          if (!(a >= needed)) return;
          visible = {face, fragment.inverse_depth, fragment.b0, fragment.b1};
        });
  }
  return fragments;
}

}  // namespace tureen::trainer
