// Seven features as seven numbers that are cheap to store and say how much a loss shows: a linear
// map that encoder and decoder of a slim file share (docs/format.md, version 3).
//
// A network hides most of what happens to its features: some directions of their space move the
// colour a lot, others hardly. In the basis of slim_basis() a step along any axis moves the colour
// by the same amount in the mean, and what neighbouring texels do not tell of each other is
// uncorrelated (the Karhunen-Loeve transform of the residuals, in the metric of the colour).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/edit/feature_sensitivity.hpp"
#include "scene/triangle_soup.hpp"

namespace tureen {

/// How many values of a basis make one step of slim_basis(). Predictions fall between steps.
inline constexpr int slim_fraction = 16;

/// feature = (sum over j of column j times value j) / 65536, rounded and clamped to a byte: whole
/// numbers, so that every machine decodes the same.
struct SlimBasis {
  std::array<std::array<std::int32_t, LatticeTexture::features>, LatticeTexture::features> rows{};

  /// Values are the features themselves: nothing is lost.
  static SlimBasis identity();

  /// One feature as a byte.
  std::uint8_t feature(int f, std::span<const std::int16_t> values) const;

  /// The nearest values of each texel of `features` + 1 bytes; alpha stays what it is. Values that
  /// 16 bits do not hold are clamped.
  std::vector<std::int16_t> values_of(std::span<const std::uint8_t> texels) const;
};

/// Where slim_fraction values along any axis move the colour by `step` 255ths in the mean square.
/// `sensitivity` is mean_sensitivity() of the texture. Axes that move it less than a tenth as much
/// as the first one are taken to move it that much: the network is not linear, and far steps along
/// them would show. `weights`: how much each texel counts (SlimTexelOptions); empty: all alike.
SlimBasis slim_basis(const LatticeTexture& texture, const FeatureMatrix& sensitivity, double step,
                     std::span<const float> weights = {});

}  // namespace tureen
