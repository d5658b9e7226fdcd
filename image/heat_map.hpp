// Colour scales for numbers, readable in grey as well, and maps of the difference of two images.
#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

#include "image/image.hpp"

namespace tureen {

/// Dark violet at 0 through red and yellow to white at 1; lightness increases monotonically.
/// Clamped.
glm::vec3 heat_ramp(float t);

/// A colour and its meaning, shown beside an image.
struct LegendEntry {
  glm::u8vec4 color;
  std::string text;
};
using Legend = std::vector<LegendEntry>;

/// The colour of a difference in [0, 1] on a logarithmic scale: black for 0, then heat_ramp from
/// 1/255 to 1. The scale is logarithmic because relevant differences span two decades.
glm::u8vec4 heat(float difference);

/// heat() of the largest channel difference of each pixel. Throws UsageError if the sizes differ.
Image8 difference(const ImageF& a, const ImageF& b);

/// Legend of heat(): differences from 0/255 to 255/255, mostly doubling from entry to entry.
Legend difference_legend();

/// Images of the same height in a row. At least one.
Image8 side_by_side(std::span<const Image8> images);

/// Left, middle and right: a, b and their difference. Throws UsageError if the sizes differ.
Image8 side_by_side(const ImageF& a, const ImageF& b);

}  // namespace tureen
