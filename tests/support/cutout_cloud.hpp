// The soup for measurements of speed and agreement: a ball of cut-out triangles with lattices and a
// random colour MLP, with eight views around it.
#pragma once

#include <cstdint>

#include "scene/scene.hpp"

namespace tureen::test {

/// Fraction of a 16:9 image that the cloud covers, measured at level 5 over the eight views.
enum class CloudCoverage {
  /// 32 %. Rays that hit the cloud hit 13 triangles on average. 40 degrees, deviation 0.06.
  third,
  /// 40 %: the same soup with a narrower angle, 36 degrees.
  forty_percent,
  /// All except some pixels in 10^5; 40 triangles a ray. 11 degrees, deviation 0.1. With only a
  /// narrow angle, 3 % of the pixels are holes, because the middle of the cloud has no more layers.
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

/// Centres are in random directions at radius cbrt(u), u uniform in [0.2, 1]. Vertices are centre +
/// N(0, 0.06) in each coordinate (0.1 for CloudCoverage::all). Every feature is a random base plus
/// a gradient over the face. Alpha is 1.2 - 3 k |(b0, b1) - (1/3, 1/3)|, k uniform in [0.5, 1.8],
/// clamped. Texels have 8 bits, rounded to the value's side of the threshold. The MLP's weights are
/// N(0, 0.35), those of its last layer N(0, 0.5). Views i = 0..7: eye (3.2 cos a, 3.2 sin a, 1.2),
/// a = i pi / 4, target 0, z up.
Scene cutout_cloud(const CutoutCloudOptions& options = {});

}  // namespace tureen::test
