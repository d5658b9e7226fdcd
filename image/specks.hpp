// Holes, where the background shows through, and specks, which are single wrong pixels. Both spoil
// an image more than its PSNR shows.
#pragma once

#include <vector>

#include "image/image.hpp"

namespace tureen {

/// A speck differs by more than this from its neighbourhood in some channel, where the photograph
/// differs by less than `calm_difference` in every channel.
inline constexpr float speck_difference = 0.15f;
inline constexpr float calm_difference = 0.05f;

/// For each pixel, row by row from the top: the largest difference of R, G and B from the medians
/// of the 5x5 pixels around it. Outside the image, the nearest pixel counts.
std::vector<float> differences_from_median(const ImageF& image);

/// 1 for specks of `rendering`, else 0. Both images have the same size and are over the same
/// background.
std::vector<float> speck_map(const ImageF& photograph, const ImageF& rendering);

/// The part of each pixel that shows the background, 1 - alpha of `rendering`, where the photograph
/// is opaque; else 0. The images have the same size.
std::vector<float> hole_map(const ImageF& photograph, const ImageF& rendering);

/// The rendering at 0.4 times its brightness, with holes in magenta and specks in yellow.
Image8 marked_defects(const ImageF& photograph, const ImageF& rendering);

}  // namespace tureen
