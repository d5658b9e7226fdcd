// The 256 values of a codebook, which bytes name: those with the least squared error.
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace tureen {

/// In ascending order.
using Codebook = std::array<float, 256>;

/// The codebook with the least sum of weight times squared distance, up to the grid on which the
/// optimal intervals are sought (X. Wu, "Optimal Quantization by Matrix Searching", 1991; here by
/// divide and conquer), refined by Lloyd's iteration. At most 256 different values are kept as they
/// are. `values` are finite, at least one; `weights` are above 0, one for each `each` consecutive
/// values, or empty: all equal.
Codebook best_codebook(std::span<const float> values, std::span<const float> weights = {},
                       std::size_t each = 1);

/// The index of the nearest value.
std::uint8_t nearest_in(const Codebook& codebook, float value);

}  // namespace tureen
