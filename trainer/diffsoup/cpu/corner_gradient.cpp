#include "trainer/diffsoup/cpu/corner_gradient.hpp"

#include "trainer/common/cpu/vector_clones.hpp"
#include "trainer/common/kernels/edge_gradient.hpp"

namespace tureen::trainer {

namespace {

TUREEN_ALWAYS_INLINE kernels::EdgePixel edge_pixel(const BatchImage& image, std::size_t pixel) {
  kernels::EdgePixel result;
  result.face = image.visible[pixel].face;
  result.inverse_depth = image.visible[pixel].inverse_depth;
  const std::size_t pixels = image.pixels();
  for (std::size_t c = 0; c < 3; ++c) {
    result.color[c] = image.color[c * pixels + pixel];
    result.gradient[c] = image.by_color[c * pixels + pixel];
  }
  return result;
}

/// Adds the gradients from the four edges of a pixel that shows the face. If both pixels of an edge
/// show it, each adds the same; then the left or upper one adds both.
TUREEN_ALWAYS_INLINE void add_edges(const BatchImage& image, const kernels::ProjectedFace& face,
                                    int x, int y, float slide, float (&corners)[3][3]) {
  const std::size_t width = std::size_t(image.view.width);
  const auto pixel = [&](int column, int row) {
    return edge_pixel(image, std::size_t(row) * width + std::size_t(column));
  };
  const kernels::EdgePixel p = pixel(x, y);
  const auto add_edge = [&](int qx, int qy, bool after) __attribute__((always_inline)) {
    const kernels::EdgePixel q = pixel(qx, qy);
    if (q.face == p.face && !after) return;
    const bool background = q.face == no_face;
    const kernels::ProjectedFace* other = background ? nullptr : &image.projected[q.face];
    const kernels::PointGradient point =
        kernels::edge_gradient(face, other, x, y, qx, qy, p, q, background, 2 * slide);
    if (point.kind != kernels::EdgeCase::none)
      kernels::distribute(image.view, face, point, corners);
  };
  if (x > 0) add_edge(x - 1, y, false);
  if (x + 1 < image.view.width) add_edge(x + 1, y, true);
  if (y > 0) add_edge(x, y - 1, false);
  if (y + 1 < image.view.height) add_edge(x, y + 1, true);
}

}  // namespace

TUREEN_VECTOR_CLONES TUREEN_FLATTEN void find_corner_gradients(BatchImage& image, std::size_t tile,
                                                               float slide) {
  std::uint32_t begin = 0;
  for (std::uint32_t i = image.bin_begin[tile]; i < image.bin_begin[tile + 1]; ++i) {
    const std::uint32_t end = image.fragments_end[i];
    if (begin == end) continue;  // its gradient is not read
    CornerGradient& sum = image.corner_gradient[i];
    sum = {};
    for (const GradientFragment& fragment :
         image.fragments_of({std::uint32_t(tile), i, begin, end, 0})) {
      if (!fragment.visible) continue;
      sum.error += image.loss[image.pixel_of(fragment)];
      add_edges(image, image.projected[image.bins[i]], int(fragment.x), int(fragment.y), slide,
                sum.corners);
    }
    begin = end;
  }
}

void collect_fragments(BatchImage& image, std::size_t tile) {
  std::vector<GradientFragment>& fragments = image.fragments[tile];
  const std::uint32_t end = image.bin_begin[tile + 1];
  const bool empty = image.bin_begin[tile] == end;
  image.by_features[tile].resize(empty ? 0 : image.visible_end[end - 1]);
  auto next = image.by_features[tile].begin();
  for (std::size_t i = 0; i < (empty ? 0 : image.fragments_end[end - 1]); ++i) {
    const std::size_t pixel = image.pixel_of(fragments[i]);
    fragments[i].depth_or_factor = image.loss[pixel];
    if (fragments[i].visible) *next++ = image.features[pixel];
  }
}

}  // namespace tureen::trainer
