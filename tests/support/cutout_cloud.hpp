// The soup that speed and agreement are measured on: a ball of cut-out triangles with lattices and
// a random color MLP, with eight views around it.
#pragma once

#include <cstdint>

#include "scene/scene.hpp"

namespace tureen::test {

/// How much of a 16:9 image the cloud covers, measured at level 5 over the eight views.
enum class CloudCoverage {
  /// 32 %; rays that hit anything hit 13 triangles in the mean. 40 degrees, deviation 0.06.
  third,
  /// 40 %: the same soup through a narrower angle, 36 degrees.
  forty_percent,
  /// All but some pixels in 10^5; 40 triangles a ray. A narrow angle alone leaves 3 % of holes, as
  /// the middle of the cloud has no more layers: 11 degrees, and triangles of deviation 0.1.
  all,
};

struct CutoutCloudOptions {
  int triangles = 15000;
  int level = 5;  // 0..7
  std::uint64_t seed = 1;
  CloudCoverage coverage = CloudCoverage::third;
  int width = 1280;
  int height = 720;
};

/// Centres in random directions at radius cbrt(u), u uniform in [0.2, 1]; vertices = centre +
/// N(0, 0.06) a coordinate (0.1 where all is covered). Every feature is a random base plus a
/// gradient over the face; alpha = 1.2 - 3 k |(b0, b1) - (1/3, 1/3)|, k uniform in [0.5, 1.8],
/// clamped. 8 bits a texel, rounded to the side of the threshold that the value lies on. The MLP's
/// weights are N(0, 0.35), those of its last layer N(0, 0.5). Views i = 0..7: eye (3.2 cos a, 3.2
/// sin a, 1.2), a = i pi / 4, target 0, z up.
Scene cutout_cloud(const CutoutCloudOptions& options = {});

}  // namespace tureen::test
