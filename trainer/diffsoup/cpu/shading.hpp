// Colours of visible pixels, and the way back from the colour's gradient to features and network.
#pragma once

#include "trainer/diffsoup/cpu/batch_image.hpp"
#include "trainer/diffsoup/cpu/texture_store.hpp"

namespace tureen::trainer {

/// Where shading reads from.
struct ShadingInput {
  const float* texture;  // TextureStore::values
  int level;
  const MlpParameters* mlp;
  const float* background;  // 3
  /// Not 0: gradients of features are rounded to half precision, times this.
  float half_scale = 0;
};

/// Rows [y0, y1) of image.color.
void shade_rows(BatchImage& image, const ShadingInput& input, int y0, int y1);

/// Fills image.gradient of rows [y0, y1) from image.by_color, and returns what these
/// rows add to the gradient of the network.
void shade_rows_backward(BatchImage& image, const ShadingInput& input, int y0, int y1,
                         MlpParameters& mlp_gradient);

}  // namespace tureen::trainer
