// What the kernels know of a batch and of the model: plain pointers into the device's memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "scene/lattice.hpp"
#include "trainer/common/cuda/kernel.hpp"
#include "trainer/common/kernels/fragments.hpp"
#include "trainer/common/kernels/projection.hpp"
#include "trainer/diffsoup/model.hpp"

namespace tureen::trainer::cuda {

/// Loss kernels work in tiles of this size. A tile and its margin of ten pixels, weighed in one
/// direction, are 22 KB of a block's memory.
inline constexpr int tile_width = 32, tile_height = 16;

/// One image of a batch. Its pixels follow those of the images before it.
struct DeviceImage {
  kernels::View view;
  std::uint32_t draw_key;
  std::size_t first_pixel;  // in arrays with one entry a pixel
  unsigned first_tile;      // of the loss kernels' tiles
  unsigned tiles_x;
  // Of the photograph; null where the image has none.
  const std::uint8_t* target;   // three planes
  const std::uint8_t* ignored;  // null where all pixels count
  std::uint16_t* baseline;      // null without a baseline

  TUREEN_HOST_DEVICE std::size_t pixels() const {
    return std::size_t(view.width) * std::size_t(view.height);
  }
};

/// The sums that a step reports, an image each, in fixed point of loss_scale or counted.
struct ImageSums {
  Fixed l1, dissimilarity, squared;
  unsigned long long shaded, non_finite;
};

/// All images of a batch.
struct DeviceBatch {
  const DeviceImage* images;
  unsigned count;
  std::size_t pixels;  // of all

  /// The image that holds a pixel of the batch.
  TUREEN_HOST_DEVICE const DeviceImage& image_of(std::size_t pixel) const {
    unsigned i = 0;
    while (i + 1 < count && images[i + 1].first_pixel <= pixel) ++i;
    return images[i];
  }
};

/// The model and what is made of it, constant while an image is drawn.
struct DeviceModel {
  std::size_t faces;
  int min_level, max_level;
  const float* positions;  // [face][3][3]
  const float* values;     // [face][fine texel][channels], through the sigmoid
  const float* alpha;      // [face][fine texel]
  const float* mlp;        // [mlp_parameters]
  float background[3];

  TUREEN_HOST_DEVICE std::size_t fine_texels() const { return lattice::texel_count(max_level); }
};

/// What a pixel shows, one number: the inverse depth's bits, which are ordered like the positive
/// floats that they are, above the complement of the face. The larger one is nearer, or as near and
/// of a lower face. 0 where nothing shows.
using VisibleKey = unsigned long long;

TUREEN_HOST_DEVICE VisibleKey visible_key(float inverse_depth, std::uint32_t face) {
  std::uint32_t bits;
  std::memcpy(&bits, &inverse_depth, sizeof bits);
  return VisibleKey(bits) << 32 | VisibleKey(~face);
}

/// Of a key that is not 0.
TUREEN_HOST_DEVICE std::uint32_t face_of(VisibleKey key) { return ~std::uint32_t(key); }

TUREEN_HOST_DEVICE float inverse_depth_of(VisibleKey key) {
  const std::uint32_t bits = std::uint32_t(key >> 32);
  float result;
  std::memcpy(&result, &bits, sizeof result);
  return result;
}

}  // namespace tureen::trainer::cuda
