// A contact sheet: thumbnails of several images in one image.
#pragma once

#include <span>

#include "image/image.hpp"

namespace tureen {

/// Thumbnails with sides of at most `cell` pixels, left to right and top to bottom, on a
/// transparent background with margins. The number of columns makes the sheet about square.
Image8 contact_sheet(std::span<const Image8> images, int cell = 320);

/// The thumbnail of one image. A caller that keeps thumbnails needs no full images.
Image8 thumbnail(const Image8& image, int cell = 320);

}  // namespace tureen
