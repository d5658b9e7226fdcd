// Where two pictures differ, as a picture.
#pragma once

#include "soup/image.hpp"

namespace tureen::cli {

/// Left, middle and right: a, b, and the largest difference in a channel of each pixel on a
/// logarithmic scale: black for none, then dark violet at 1/255 through red and yellow to white at
/// 1. Logarithmic, since the differences worth looking for span two decades. Throws UsageError
/// when the sizes differ.
Image8 side_by_side(const ImageF& a, const ImageF& b);

/// The colour that stands for a difference in [0, 1].
glm::u8vec4 heat(float difference);

}  // namespace tureen::cli
