// The data of one image of a batch during a step.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/camera.hpp"
#include "scene/triangle_soup.hpp"
#include "trainer/common/kernels/fragments.hpp"
#include "trainer/diffsoup/kernels/texel_pack.hpp"
#include "trainer/diffsoup/model.hpp"

namespace tureen::trainer {

static_assert(kernels::max_image_side < 1 << 15);  // GradientFragment stores 15 bits

/// Square tiles of this side: a tile's depths and winners stay in the first-level cache.
inline constexpr int tile_side = 32;

/// The visible face of a pixel.
struct VisiblePixel {
  std::uint32_t face = no_face;  // no_face for the background
  float inverse_depth = 0;
  float b0 = 0, b1 = 0;  // barycentrics
};

/// A fragment with a gradient: it is visible, or in front of the visible one and rejected.
struct GradientFragment {
  std::uint32_t visible : 1, x : 15, y : 16;
  float b0, b1;           // barycentrics
  float depth_or_factor;  // the inverse depth; after collect_fragments() the score's factor
};

/// The gradient of a face's corners from its visible pixels in one tile.
struct CornerGradient {
  float corners[3][3];  // in the view's axes right, down, forward
  float error;          // sum over pixels and channels of |C - G|
};

/// A face in a tile.
struct TileFace {
  std::uint32_t tile, entry;    // entry of BatchImage::bins
  std::uint32_t begin, end;     // in the fragments of the tile
  std::uint32_t visible_begin;  // in its by_features
};

struct BatchImage {
  kernels::View view;
  std::uint32_t draw_key = 0;
  int tiles_x = 0, tiles_y = 0;

  std::vector<kernels::ProjectedFace> projected;  // one per face
  std::vector<std::uint32_t> bin_begin;           // one per tile, and the end
  std::vector<std::uint32_t> bins;                // faces of each tile, the nearest first
  std::vector<float> nearest;                     // one per face: no fragment is nearer

  // For the gradient. Hidden faces have no fragments.
  bool keeps_fragments = true;  // otherwise the rest of this group stays empty
  std::vector<std::vector<GradientFragment>> fragments;  // of each tile, in the order of its faces
  std::vector<std::vector<Texel>> by_features;           // of their visible ones
  std::vector<std::uint32_t> fragments_end;     // one per entry of bins, in its tile's list
  std::vector<std::uint32_t> visible_end;       // the same in by_features
  std::vector<CornerGradient> corner_gradient;  // one per entry of bins
  std::vector<std::uint32_t> tiles_begin;  // one per face, and the end: its part of tiles_of_faces
  std::vector<TileFace> tiles_of_faces;    // with fragments only

  // One per pixel, row by row from the top.
  std::vector<VisiblePixel> visible;
  std::vector<float> color;     // three planes
  std::vector<float> by_color;  // three planes: dL/dcolour
  std::vector<float> loss;      // sum over channels of |C - G|; later the score's factor
  /// Of the visible face: features and alpha after the forward pass, dL/dfeature and 0 after the
  /// backward pass; undefined for the background. Empty if there is no backward pass.
  std::vector<Texel> features;

  std::size_t pixels() const { return std::size_t(view.width) * view.height; }
  std::size_t tiles() const { return std::size_t(tiles_x) * tiles_y; }
  kernels::Rectangle tile(std::size_t index) const;
  std::size_t pixel_of(const GradientFragment& fragment) const {
    return std::size_t(fragment.y) * std::size_t(view.width) + fragment.x;
  }
  std::span<const GradientFragment> fragments_of(const TileFace& face) const {
    return std::span(fragments[face.tile]).subspan(face.begin, face.end - face.begin);
  }
};

/// The camera relative to a model's origin.
kernels::View view_of(const Camera& camera, glm::dvec3 origin, double near, double far);

}  // namespace tureen::trainer
