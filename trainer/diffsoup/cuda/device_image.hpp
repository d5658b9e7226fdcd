// The batch and the model for kernels: plain pointers into the device's memory.
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

/// Tile size of the loss kernels. A tile with its margin of ten pixels, filtered in one direction,
/// needs 22 KB of a block's memory.
inline constexpr int tile_width = 32, tile_height = 16;

/// One image of a batch. Its pixels follow the pixels of the previous images.
struct DeviceImage {
  kernels::View view;
  std::uint32_t draw_key;
  std::size_t first_pixel;  // in arrays with one entry per pixel
  unsigned first_tile;      // index of its first tile in the loss kernels
  unsigned tiles_x;
  // Data of the photograph; null without one.
  const std::uint8_t* target;   // three planes
  const std::uint8_t* ignored;  // null if no pixel is ignored
  std::uint16_t* baseline;      // null without a baseline

  TUREEN_HOST_DEVICE std::size_t pixels() const {
    return std::size_t(view.width) * std::size_t(view.height);
  }
};

/// The sums of one image for the step's report: fixed point of loss_scale, and counts.
struct ImageSums {
  Fixed l1, dissimilarity, squared;
  unsigned long long shaded, non_finite;
};

/// All images of a batch.
struct DeviceBatch {
  const DeviceImage* images;
  unsigned count;
  std::size_t pixels;  // of all images

  /// The image that holds a pixel of the batch.
  TUREEN_HOST_DEVICE const DeviceImage& image_of(std::size_t pixel) const {
    unsigned i = 0;
    while (i + 1 < count && images[i + 1].first_pixel <= pixel) ++i;
    return images[i];
  }
};

/// The model and its textures, constant while an image is drawn.
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

/// The visible face of a pixel in one number. The upper half holds the bits of the inverse depth,
/// which have the order of positive floats; the lower half holds the complement of the face. A
/// larger key is nearer, or equally near with a lower face. 0 means no face.
using VisibleKey = unsigned long long;

TUREEN_HOST_DEVICE VisibleKey visible_key(float inverse_depth, std::uint32_t face) {
  std::uint32_t bits;
  std::memcpy(&bits, &inverse_depth, sizeof bits);
  return VisibleKey(bits) << 32 | VisibleKey(~face);
}

/// The face of a key that is not 0.
TUREEN_HOST_DEVICE std::uint32_t face_of(VisibleKey key) { return ~std::uint32_t(key); }

TUREEN_HOST_DEVICE float inverse_depth_of(VisibleKey key) {
  const std::uint32_t bits = std::uint32_t(key >> 32);
  float result;
  std::memcpy(&result, &bits, sizeof result);
  return result;
}

}  // namespace tureen::trainer::cuda
