// Which faces need an alpha test, and which can never be seen.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/triangle_soup.hpp"

namespace tureen {

enum class FaceAlpha : std::uint8_t {
  opaque,       // every fragment exists
  cut_out,      // to be tested
  transparent,  // no fragment exists
};

/// One a face, decided from the data. Interpolated alpha stays between the values that it is
/// interpolated from, so the smallest and the largest decide, exactly (docs/leaving-out.md,
/// alpha-test and transparent-faces).
std::vector<FaceAlpha> classify_alpha(const TriangleSoup& soup);

/// False for a face that no rasteriser can draw: a corner that is not finite, or an area of nothing
/// (docs/numerics.md, G1).
bool drawable(const TriangleSoup& soup, std::uint32_t face);

}  // namespace tureen
