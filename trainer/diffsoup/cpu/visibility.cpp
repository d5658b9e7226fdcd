#include "trainer/diffsoup/cpu/visibility.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/radix_sort.hpp"
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

/// The inverse depth that no fragment of the face exceeds: that of its plane at a corner of its
/// rectangle.
float nearest_of(const kernels::ProjectedFace& face, double near) {
  const float width = float(face.x1 - 1 - face.x0), height = float(face.y1 - 1 - face.y0);
  float sum = 0, across = 0, down = 0, magnitude = 0;
  for (int k = 0; k < 3; ++k) {
    sum += face.c[k];
    across += face.dx[k] * width;
    down += face.dy[k] * height;
    magnitude += std::abs(face.c[k]) + std::abs(face.dx[k]) * width + std::abs(face.dy[k]) * height;
  }
  // for_each_fragment rounds each term at most six times, by 6e-8 of its size.
  const float nearest = sum + std::max(across, 0.0f) + std::max(down, 0.0f) + 1e-6f * magnitude;
  const float limit = float(1 / near);
  return nearest < limit ? nearest : limit;  // also if overflow made it NaN
}

/// Faces of the image, those with the nearest parts first.
std::vector<KeyedIndex> front_to_back(const BatchImage& image) {
  std::vector<KeyedIndex> order, scratch;
  for (std::size_t face = 0; face < image.projected.size(); ++face)
    if (!image.projected[face].empty())
      order.push_back({~sort_key(image.nearest[face]), std::uint32_t(face)});
  radix_sort(order, scratch);
  return order;
}

}  // namespace

void bin_faces(BatchImage& image, const Model& model) {
  const std::size_t faces = model.faces();
  image.projected.resize(faces);
  image.nearest.resize(faces);
  image.bin_begin.assign(std::size_t(image.tiles_x) * image.tiles_y + 1, 0);
  for (std::size_t face = 0; face < faces; ++face) {
    image.projected[face] = kernels::project(image.view, &model.positions[3 * face].x);
    image.nearest[face] = nearest_of(image.projected[face], image.view.near);
    for_each_tile(image, image.projected[face],
                  [&](std::size_t tile) { ++image.bin_begin[tile + 1]; });
  }
  for (std::size_t tile = 1; tile < image.bin_begin.size(); ++tile)
    image.bin_begin[tile] += image.bin_begin[tile - 1];
  image.bins.resize(image.bin_begin.back());
  image.reached_in_tile.assign(image.bins.size(), 0);
  std::vector<std::uint32_t> next(image.bin_begin.begin(), image.bin_begin.end() - 1);
  for (const KeyedIndex& item : front_to_back(image))
    for_each_tile(image, image.projected[item.index],
                  [&](std::size_t tile) { image.bins[next[tile]++] = item.index; });
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
  // The inverse depth that all pixels of the tile reach. It is updated rarely, since it takes as
  // long as some faces.
  float behind = 0;
  constexpr std::uint32_t faces_an_update = 32;
  for (std::uint32_t i = image.bin_begin[tile]; i < image.bin_begin[tile + 1]; ++i) {
    const std::uint32_t face = image.bins[i];
    if ((i - image.bin_begin[tile]) % faces_an_update == faces_an_update - 1) {
      behind = std::numeric_limits<float>::infinity();
      for (int y = within.y0; y < within.y1; ++y)
        for (int x = within.x0; x < within.x1; ++x)
          behind = std::min(behind, image.visible[std::size_t(y) * width + x].inverse_depth);
    }
    if (image.nearest[face] < behind) break;  // this face is hidden, and so are those behind it
    const float* texture = alpha + face * texels;
    bool reached = false;
    kernels::for_each_fragment(
        image.view, image.projected[face],
        within, [&](const kernels::Fragment& fragment) __attribute__((always_inline)) {
          ++fragments;
          const std::size_t pixel = std::size_t(fragment.y) * width + std::size_t(fragment.x);
          VisiblePixel& visible = image.visible[pixel];
          if (fragment.inverse_depth < visible.inverse_depth ||
              (fragment.inverse_depth == visible.inverse_depth && face > visible.face))
            return;
          reached = true;
          const auto at = lattice::footprint(level, fragment.b0, fragment.b1);
          const float a = lattice::interpolated(at, texture);
          const float needed =
              masking == Masking::threshold
                  ? alpha_threshold
                  : kernels::uniform_draw(image.draw_key, std::uint32_t(pixel), face);
          if (!(a >= needed)) return;
          visible = {face, fragment.inverse_depth, fragment.b0, fragment.b1};
        });
    image.reached_in_tile[i] = reached;
  }
  return fragments;
}

void find_reached(BatchImage& image) {
  image.reached.assign(image.projected.size(), 0);
  for (std::size_t i = 0; i < image.bins.size(); ++i)
    image.reached[image.bins[i]] |= image.reached_in_tile[i];
}

}  // namespace tureen::trainer
