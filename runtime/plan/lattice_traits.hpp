// Measured properties of a lattice texture, the conditions of specialisations.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "runtime/plan/color_mlp_source.hpp"
#include "scene/triangle_soup.hpp"

namespace tureen {

struct LatticeTraits {
  FeatureRanges ranges;  // of each feature over the measured faces
  std::size_t constant_faces = 0;
  bool shares_texels = false;  // some texels belong to several of these faces
  int lowest_level = 0;
  int highest_level = 0;
};

/// Measures `faces` of a soup with this texture. O(texels).
LatticeTraits measure(const LatticeTexture& texture, std::span<const std::uint32_t> faces);

/// Largest error over all features, in feature units, of interpolating the face by its three corner
/// texels only. Nullopt if the error exceeds `largest`, or if the cut-out would change: alpha is
/// neither at least 1/2 throughout nor affine up to rounding. Lattice interpolation is linear
/// between texels, so the bound holds everywhere on the face. Most faces need only a few texels.
std::optional<float> affine_residual(const LatticeTexture& texture, std::uint32_t face,
                                     float largest);

/// Upper bound of the change of the network's prediction, before blending, when one of the features
/// `first` .. `end` - 1 changes by one. Features without an input do not count. It is the product
/// of the layers' largest absolute row sums and the sigmoid's slope 1/4.
double network_gain(const ColorMlp& mlp, int first, int end);

/// Largest difference of base colour and network output, which is in [0, 1], for features in these
/// ranges: 1, except for float texels outside [0, 1].
double base_from_network(const FeatureRanges& ranges);

/// Upper bound of the change of the colour when the features, in these ranges, change by one: the
/// network's gain and the blend.
double color_gain(const ColorMlp& mlp, const FeatureRanges& ranges);

}  // namespace tureen
