#include "trainer/diffsoup/cpu/visibility.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "base/radix_sort.hpp"
#include "trainer/common/cpu/vector_clones.hpp"
#include "trainer/diffsoup/cpu/visibility_kernels.hpp"

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

/// The inverse depth that no fragment of the face exceeds: that of its nearest corner, or of its
/// plane at a corner of its rectangle.
float nearest_of(const kernels::View& view, const kernels::ProjectedFace& face,
                 const float* corners) {
  const float width = float(face.x1 - 1 - face.x0), height = float(face.y1 - 1 - face.y0);
  float sum = 0, across = 0, down = 0, magnitude = 0;
  for (int k = 0; k < 3; ++k) {
    sum += face.c[k];
    across += face.dx[k] * width;
    down += face.dy[k] * height;
    magnitude += std::abs(face.c[k]) + std::abs(face.dx[k]) * width + std::abs(face.dy[k]) * height;
  }
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    double at[3];
    kernels::view_coordinates(view, corners + 3 * k, at);
    least = at[2] < least ? at[2] : least;
  }
  const float of_plane = sum + std::max(across, 0.0f) + std::max(down, 0.0f);
  const float of_corner = float(1 / std::max(least, view.near));
  // draw_tile rounds each term at most six times, by 6e-8 of its size. Rounded coefficients also
  // move the nearest corner by as little.
  const float nearest = std::min(of_plane, of_corner) + 1e-6f * magnitude;
  const float limit = float(1 / view.near);
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

/// Removes the fragments behind the visible ones from the tile's list, and marks the visible ones.
/// Faces from `end` on were skipped.
void keep_gradient_fragments(BatchImage& image, std::size_t tile, std::uint32_t end) {
  std::vector<GradientFragment>& list = image.fragments[tile];
  std::size_t kept = 0, from = 0;
  std::uint32_t visible = 0;
  for (std::uint32_t i = image.bin_begin[tile]; i < end; ++i) {
    const std::uint32_t face = image.bins[i];
    for (; from < image.fragments_end[i]; ++from) {
      GradientFragment fragment = list[from];
      const VisiblePixel& shown = image.visible[image.pixel_of(fragment)];
      // At equal depths the lower face is in front.
      if (fragment.depth_or_factor < shown.inverse_depth ||
          (fragment.depth_or_factor == shown.inverse_depth && face > shown.face))
        continue;
      fragment.visible = face == shown.face;
      visible += fragment.visible;
      list[kept++] = fragment;
    }
    image.fragments_end[i] = std::uint32_t(kept);
    image.visible_end[i] = visible;
  }
  for (std::uint32_t i = end; i < image.bin_begin[tile + 1]; ++i) {
    image.fragments_end[i] = std::uint32_t(kept);
    image.visible_end[i] = visible;
  }
}

/// Projects all faces, and finds their nearest parts.
TUREEN_VECTOR_CLONES TUREEN_FLATTEN void project_faces(const kernels::View& view,
                                                       const float* corners, std::size_t faces,
                                                       kernels::ProjectedFace* projected,
                                                       float* nearest) {
  for (std::size_t face = 0; face < faces; ++face, corners += 9) {
    projected[face] = kernels::project(view, corners);
    if (!projected[face].empty()) nearest[face] = nearest_of(view, projected[face], corners);
  }
}

}  // namespace

void bin_faces(BatchImage& image, const Model& model) {
  const std::size_t faces = model.faces();
  image.projected.resize(faces);
  image.nearest.resize(faces);
  image.bin_begin.assign(image.tiles() + 1, 0);
  project_faces(image.view, &model.positions.data()->x, faces, image.projected.data(),
                image.nearest.data());
  for (const kernels::ProjectedFace& face : image.projected)
    for_each_tile(image, face, [&](std::size_t tile) { ++image.bin_begin[tile + 1]; });
  for (std::size_t tile = 1; tile < image.bin_begin.size(); ++tile)
    image.bin_begin[tile] += image.bin_begin[tile - 1];
  image.bins.resize(image.bin_begin.back());
  if (image.keeps_fragments) {
    image.fragments.resize(image.tiles());
    image.by_features.resize(image.tiles());
    image.fragments_end.resize(image.bins.size());
    image.visible_end.resize(image.bins.size());
    image.corner_gradient.resize(image.bins.size());
  }
  std::vector<std::uint32_t> next(image.bin_begin.begin(), image.bin_begin.end() - 1);
  for (const KeyedIndex& item : front_to_back(image))
    for_each_tile(image, image.projected[item.index],
                  [&](std::size_t tile) { image.bins[next[tile]++] = item.index; });
}

std::uint64_t find_visible(BatchImage& image, std::size_t tile, const float* alpha, int level,
                           Masking masking) {
  const TileVisibility found = draw_tile(image, tile, {alpha, level, masking});
  if (image.keeps_fragments) keep_gradient_fragments(image, tile, found.end);
  return found.fragments;
}

void list_faces(BatchImage& image) {
  assert(image.keeps_fragments);
  image.tiles_begin.assign(image.projected.size() + 1, 0);
  const auto for_each_entry = [&](auto&& visit) {
    for (std::uint32_t tile = 0; tile < image.tiles(); ++tile) {
      std::uint32_t begin = 0, visible = 0;
      for (std::uint32_t i = image.bin_begin[tile]; i < image.bin_begin[tile + 1]; ++i) {
        const std::uint32_t end = image.fragments_end[i];
        if (end > begin) visit(TileFace{tile, i, begin, end, visible});
        begin = end;
        visible = image.visible_end[i];
      }
    }
  };
  for_each_entry([&](const TileFace& at) { ++image.tiles_begin[image.bins[at.entry] + 1]; });
  for (std::size_t face = 1; face < image.tiles_begin.size(); ++face)
    image.tiles_begin[face] += image.tiles_begin[face - 1];
  image.tiles_of_faces.resize(image.tiles_begin.back());
  std::vector<std::uint32_t> next(image.tiles_begin.begin(), image.tiles_begin.end() - 1);
  for_each_entry(
      [&](const TileFace& at) { image.tiles_of_faces[next[image.bins[at.entry]]++] = at; });
}

}  // namespace tureen::trainer
