// What the transparent pixels of a dataset's photographs are: the background of an object that was
// cut out, or a mask.
#pragma once

#include <cstddef>
#include <vector>

#include "formats/dataset/dataset.hpp"

namespace tureen {

/// The meaning, and the number of photographs with more than one transparent pixel in a thousand.
struct AlphaUse {
  AlphaMeaning meaning = AlphaMeaning::ignore;
  std::size_t photographs = 0;
};

/// Fractions of transparent pixels.
struct AlphaCounts {
  double all = 0;     // of the image
  double border = 0;  // of its first and last row and column
};
AlphaCounts alpha_counts(const Image8& image);

/// Decides by all photographs. Transparent pixels are background if, in at least half of the
/// photographs, they are at least a quarter of the image and at least half of its border: around an
/// object that was cut out. Otherwise they are a mask: people, dirt, borders without lens. If no
/// photograph has more than one transparent pixel in a thousand, alpha is ignored.
AlphaUse alpha_of(const std::vector<AlphaCounts>& photographs);

/// Makes the photograph opaque; for a mask, first marks its transparent pixels as ignored. A
/// photograph whose pixels would all be ignored keeps them. Nothing for a background. Pixels in a
/// file stay there.
void apply_alpha(AlphaMeaning meaning, Photograph& photograph);

}  // namespace tureen
