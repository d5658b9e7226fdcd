// Classifies faces by alpha: needing an alpha test, opaque, or never visible.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/triangle_soup.hpp"

namespace tureen {

enum class FaceAlpha : std::uint8_t {
  opaque,       // every fragment exists
  cut_out,      // needs the alpha test
  transparent,  // no fragment exists
};

/// One class a face, computed from the data. Interpolated alpha stays within the range of its
/// inputs, so the smallest and the largest value decide exactly (docs/specialisations.md,
/// alpha-test and transparent-faces).
std::vector<FaceAlpha> classify_alpha(const TriangleSoup& soup);

/// False for a face that no rasteriser draws: a corner is not finite, or the area is 0
/// (docs/numerics.md, G1).
bool drawable(const TriangleSoup& soup, std::uint32_t face);

}  // namespace tureen
