// The gradient of the corners from the edges in the image, tile by tile. The pixels of a tile stay
// in the cache, although several faces read them.
#pragma once

#include "trainer/diffsoup/cpu/batch_image.hpp"

namespace tureen::trainer {

/// Fills image.corner_gradient of the tile's faces from image.color, image.by_color and image.loss.
/// `slide`: scale of the texture slide, kernels/edge_gradient.hpp.
void find_corner_gradients(BatchImage& image, std::size_t tile, float slide);

/// Copies what the tile's fragments need from image.features and image.loss (then the score's
/// factor) to the fragments. Faces read these in order, which is faster than by pixels.
void collect_fragments(BatchImage& image, std::size_t tile);

}  // namespace tureen::trainer
