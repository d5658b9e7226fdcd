// The data of one image of a batch during a step.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/camera.hpp"
#include "scene/triangle_soup.hpp"
#include "trainer/common/kernels/fragments.hpp"
#include "trainer/diffsoup/model.hpp"

namespace tureen::trainer {

/// Square tiles of this side: a tile's depths and winners stay in the first-level cache.
inline constexpr int tile_side = 32;

/// The visible face of a pixel.
struct VisiblePixel {
  std::uint32_t face = no_face;  // no_face for the background
  float inverse_depth = 0;
  float b0 = 0, b1 = 0;  // barycentrics
};

/// The gradients of a pixel for its visible face. One cache line holds all of them.
struct alignas(64) PixelGradient {
  float features[channels];  // dL/dfeature 0..6, and 0
  float color[3];
  float by_color[3];  // dL/dcolour
  float error;        // sum over channels of |C - G|
};

struct BatchImage {
  kernels::View view;
  std::uint32_t draw_key = 0;
  int tiles_x = 0, tiles_y = 0;

  std::vector<kernels::ProjectedFace> projected;  // one per face
  std::vector<std::uint32_t> bin_begin;           // one per tile, and the end
  std::vector<std::uint32_t> bins;                // faces of each tile, the nearest first
  std::vector<float> nearest;                     // one per face: no fragment is nearer
  /// One per face: whether one of its fragments was nearer than all that were accepted before it.
  /// Nothing depends on the others, which are hidden.
  std::vector<std::uint8_t> reached;
  std::vector<std::uint8_t> reached_in_tile;  // the same for each entry of bins

  // One per pixel, row by row from the top.
  std::vector<VisiblePixel> visible;
  std::vector<float> color;     // three planes
  std::vector<float> by_color;  // three planes: dL/dcolour
  std::vector<float> loss;      // sum over channels of |C - G|; later the score's factor
  std::vector<PixelGradient> gradient;

  std::size_t pixels() const { return std::size_t(view.width) * view.height; }
  kernels::Rectangle tile(std::size_t index) const;
};

/// The camera relative to a model's origin.
kernels::View view_of(const Camera& camera, glm::dvec3 origin, double near, double far);

}  // namespace tureen::trainer
