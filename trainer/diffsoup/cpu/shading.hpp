// Colours of visible pixels, and the backward pass from the colour's gradient to features and
// network.
#pragma once

#include "trainer/diffsoup/cpu/batch_image.hpp"
#include "trainer/diffsoup/cpu/texture_store.hpp"

namespace tureen::trainer {

/// The inputs of shading.
struct ShadingInput {
  const Texel* texture;  // TextureStore::values
  int level;
  const MlpParameters* mlp;
  const float* background;  // 3
  /// If not 0, feature gradients are rounded to half precision after multiplication by this.
  float half_scale = 0;
};

/// Fills rows [y0, y1) of image.color, and of image.features unless it is empty.
void shade_rows(BatchImage& image, const ShadingInput& input, int y0, int y1);

/// Replaces image.features in rows [y0, y1) by the gradient from image.by_color. `mlp_gradient`:
/// output, the part of these rows in the network's gradient.
void shade_rows_backward(BatchImage& image, const ShadingInput& input, int y0, int y1,
                         MlpParameters& mlp_gradient);

}  // namespace tureen::trainer
