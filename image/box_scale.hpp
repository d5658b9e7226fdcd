// Smaller images by area averaging: thumbnails, and photographs at half size for training.
#pragma once

#include "image/image.hpp"

namespace tureen {

/// The image at width x height, each at least 1 pixel. Each pixel is the mean over its area (box
/// filter), weighted by alpha so that transparent pixels do not darken edges. Pixels with alpha 0
/// become (0, 0, 0, 0). The same size returns the same image; enlarging repeats pixels.
///
/// Time for 1080 x 1920 on one core: about 7 ms at a quarter, 16 ms at nine tenths of the size.
Image8 box_scaled(const Image8& image, int width, int height);

}  // namespace tureen
