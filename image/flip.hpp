// FLIP: the visible difference when flipping between two images (Andersson, Nilsson,
// Akenine-Moller, Oskarsson, Astrom and Fairchild, "FLIP: A Difference Evaluator for Alternating
// Images", HPG 2020). This is the LDR version, for images in sRGB.
#pragma once

#include <vector>

#include "image/image.hpp"

namespace tureen {

struct FlipOptions {
  /// Pixels per degree of the visual field. The default, 67, is the paper's: a distance of 0.7 m
  /// from a screen 0.7 m and 3840 pixels wide.
  double pixels_per_degree = 67.0;
};

struct FlipResult {
  double mean = 0;         // over all pixels
  std::vector<float> map;  // one error in [0, 1] a pixel, row by row from the top
};

/// Values are display-referred sRGB, clamped to [0, 1] (NaN becomes 0); alpha is ignored. Both
/// images have the same size, at least one pixel. Border pixels are replicated. Symmetric in its
/// arguments.
FlipResult flip(const ImageF& reference, const ImageF& test, const FlipOptions& options = {});

}  // namespace tureen
