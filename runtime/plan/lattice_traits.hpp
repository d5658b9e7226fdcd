// Measured traits of a lattice texture, for which the plan specialises.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "runtime/plan/color_mlp_source.hpp"
#include "scene/triangle_soup.hpp"

namespace tureen {

struct LatticeTraits {
  FeatureRanges ranges;  // of each feature over the faces looked at
  std::size_t constant_faces = 0;
  /// One a face looked at, in their order: the largest error of any feature, in feature units, that
  /// interpolating the face's three corner texels makes anywhere on it. Infinite where that would
  /// move the cut-out: where alpha is neither at least 1/2 throughout nor affine up to rounding.
  /// Lattice interpolation is linear between texels, so the bound holds everywhere on the face.
  std::vector<float> affine_residual;
  bool shares_texels = false;  // some texels belong to more than one of these faces
  int lowest_level = 0;
  int highest_level = 0;
};

/// Looks at `faces` of a soup with this texture. O(texels).
LatticeTraits measure(const LatticeTexture& texture, std::span<const std::uint32_t> faces);

/// How much a change by one of the features `first` .. `end` - 1 (those that it has no input for
/// count nothing) can change what the network predicts, not yet blended: an upper bound (the
/// product of the layers' largest absolute row sums and the sigmoid's slope 1/4).
double network_gain(const ColorMlp& mlp, int first, int end);

/// How far base colour and network, which is in [0, 1], may lie apart where features have these
/// ranges: 1, but for texels of floats that leave [0, 1].
double base_from_network(const FeatureRanges& ranges);

/// How much a change of the features, which have these ranges, by one can change the colour: an
/// upper bound (the network's gain and the blend).
double color_gain(const ColorMlp& mlp, const FeatureRanges& ranges);

}  // namespace tureen
