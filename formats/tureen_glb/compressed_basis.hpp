// A linear map from seven features to seven values that are cheap to code and whose errors are
// proportional to visible error. Encoder and decoder of a compressed file share it (docs/format.md,
// version 3).
//
// A network hides most changes of its features: some directions in feature space move the colour a
// lot, others hardly. In compressed_basis() a step along any axis moves the colour by the same mean
// amount, and the prediction residuals are uncorrelated. It is the Karhunen-Loeve transform of the
// residuals in the metric of the colour.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/edit/feature_sensitivity.hpp"
#include "scene/triangle_soup.hpp"

namespace tureen {

/// Basis values per step of compressed_basis(). Predictions fall between steps.
inline constexpr int compress_fraction = 16;

/// feature = (sum over j of column j times value j) / 65536, rounded and clamped to a byte. Integer
/// arithmetic makes decoding identical on every machine.
struct CompressedBasis {
  std::array<std::array<std::int32_t, LatticeTexture::features>, LatticeTexture::features> rows{};

  /// Values equal the features; lossless.
  static CompressedBasis identity();

  /// One feature as a byte.
  std::uint8_t feature(int f, std::span<const std::int16_t> values) const;

  /// The nearest values for each texel of `features` + 1 bytes; alpha is unchanged. Values are
  /// clamped to 16 bits.
  std::vector<std::int16_t> values_of(std::span<const std::uint8_t> texels) const;
};

/// The basis in which compress_fraction values along any axis move the colour by `step` / 255 in
/// the root mean square. `sensitivity` is the texture's mean_sensitivity(). Axes with less than a
/// tenth of the first one's effect are treated as having a tenth. The network is not linear, so
/// long steps along them would be visible. `weights`: weight of each texel
/// (CompressedTexelOptions); empty: equal weights.
CompressedBasis compressed_basis(const LatticeTexture& texture, const FeatureMatrix& sensitivity,
                                 double step, std::span<const float> weights = {});

}  // namespace tureen
