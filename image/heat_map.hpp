// Numbers as colours: a scale that reads in grey as well, and where two pictures differ.
#pragma once

#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "image/image.hpp"

namespace tureen {

/// Dark violet at 0 through red and yellow to white at 1; lightness grows all the way. Clamped.
glm::vec3 heat_ramp(float t);

/// A colour and what it stands for, to be shown beside a picture.
struct LegendEntry {
  glm::u8vec4 color;
  std::string text;
};
using Legend = std::vector<LegendEntry>;

/// The colour that stands for a difference in [0, 1] on a logarithmic scale: black for none, then
/// heat_ramp from 1/255 to 1. Logarithmic, since the differences worth looking for span two
/// decades.
glm::u8vec4 heat(float difference);

/// heat() of the largest difference in a channel of each pixel. Throws UsageError when the sizes
/// differ.
Image8 difference(const ImageF& a, const ImageF& b);

/// Of heat(): steps of 8 bits from 0 to 255.
Legend difference_legend();

/// Left, middle and right: a, b and their difference. Throws as it.
Image8 side_by_side(const ImageF& a, const ImageF& b);

}  // namespace tureen
