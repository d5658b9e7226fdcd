// Many images small on one, to look at a whole orbit at once.
#pragma once

#include <span>

#include "image/image.hpp"

namespace tureen::cli {

/// Thumbnails no wider and no higher than `cell` pixels, left to right and top to bottom, in as
/// many columns as make the sheet about square, on transparent ground with a margin.
Image8 contact_sheet(std::span<const Image8> images, int cell = 320);

/// The thumbnail of one image, so that not all need be kept at full size.
Image8 thumbnail(const Image8& image, int cell = 320);

}  // namespace tureen::cli
