// What a kernel gives at an image point.
#pragma once

#include <limits>

#include "scene/splats.hpp"

namespace tureen::oracle {

/// One splat at one image point. Depths are along the viewing axis, in world units.
struct SplatSample {
  double alpha = 0;  // by limited_alpha(); 0: the splat is not blended here
  /// For the comparison with opaque surfaces, and for picking.
  double depth = std::numeric_limits<double>::infinity();
  /// For SplatOrder::exact.
  double order = std::numeric_limits<double>::infinity();
};

/// alpha limited to SplatProfile::max_alpha; 0 below SplatProfile::min_alpha and for NaN.
inline double limited_alpha(double alpha, const SplatProfile& profile) {
  const double limited = alpha > double(profile.max_alpha) ? double(profile.max_alpha) : alpha;
  return limited >= double(profile.min_alpha) ? limited : 0.0;
}

}  // namespace tureen::oracle
