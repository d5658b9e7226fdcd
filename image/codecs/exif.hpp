// Orientation and focal length that a JPEG's EXIF data give (CIPA DC-008, tags 274 and 37386).
#pragma once

#include <cstddef>
#include <glm/vec2.hpp>
#include <optional>
#include <span>

#include "image/image.hpp"

namespace tureen {

/// 1 to 8; 1, as the pixels are stored, if the file has none or is no JPEG. Any bytes are safe.
int exif_orientation(std::span<const std::byte> file);

/// The focal length in millimetres, more than 0. `file` may be only the beginning. Any bytes are
/// safe.
std::optional<double> exif_focal_length(std::span<const std::byte> file);

/// The image as a viewer shows it with this orientation, 1 to 8.
Image8 turned(const Image8& image, int orientation);

/// Where the top of the turned image is in the stored one: (0, 1) is its own top, (1, 0) its right.
glm::ivec2 stored_top(int orientation);

/// Whether the orientation exchanges width and height.
inline bool swaps_sides(int orientation) { return orientation >= 5; }

}  // namespace tureen
