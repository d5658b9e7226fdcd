// Lossy compression of lattice textures with an adjustable error: the texels of a compressed file
// (docs/format.md, version 3).
//
// Features become values of a CompressedBasis, coded level by level so that coarse data come first.
// The corners of a face are predicted from the previous face, each texel of a finer level as the
// mean of its two neighbours. The residual is divided by a step and coded by a range coder. Its
// probabilities depend on the channel, the level and nearby residuals. Predictions use decoded
// values, so errors do not accumulate. With a bit price of 0 the error is at most half a step at
// every level. Otherwise the encoder weighs each error against the bits that it saves
// (rate-distortion optimised quantisation). Faces that are smooth on a level cost almost nothing.
//
// Invisible data are dropped. Features of a texel are dropped if no neighbouring alpha reaches 1/2.
// If all neighbouring alphas are on one side of 1/2, only that side is stored.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/memory_budget.hpp"
#include "formats/tureen_glb/compressed_basis.hpp"
#include "scene/triangle_soup.hpp"

namespace tureen {

/// Factors on a face's feature step, times 4: the value 4 is the factor 1.
inline constexpr std::array<std::uint8_t, 8> compress_multipliers{2, 3, 4, 6, 8, 12, 16, 32};
/// The index of the factor 1.
inline constexpr std::uint8_t one_step = 2;

/// Error limits of texels. With the defaults, visible byte texels are lossless.
struct CompressedTexelOptions {
  CompressedBasis basis = CompressedBasis::identity();
  /// Step sizes: basis values, 1..255, default 1; alphas, 1..127, default 1.
  std::uint8_t feature_step = 1;
  std::uint8_t alpha_step = 1;
  /// An index into compress_multipliers for each face. Empty: one_step for all. Faces that share
  /// texels get the smaller one.
  std::vector<std::uint8_t> coarseness = {};
  /// Whether invisible values are kept as precisely as visible ones.
  bool keep_hidden = false;
  /// Weight of a feature's squared error, one a texel, at least 0. Empty: 1 for all. Faces with
  /// equal texels store them once, with the largest weight.
  std::vector<float> weights = {};
  /// Price of a bit, at least 0, default 0: the additional error that the encoder accepts to save
  /// one bit, in weighted squared feature steps, on the finest level of a patch. Errors on coarser
  /// levels count more. At 0 each value is rounded to the nearest multiple of its step.
  double bit_price = 0;
};

/// The texture's patches and texels as bytes; float texels are rounded to bytes first. Equal
/// patches are stored once. The texture has no defect(). Throws UsageError for more than 2^32
/// texels.
std::vector<std::byte> encode_compressed_texels(const LatticeTexture& texture,
                                                const CompressedTexelOptions& options);

/// The decoded texture, without a color MLP: byte texels, patches in the order of their first face.
/// Throws InputError, which names `file`, if the bytes are truncated, have another number of faces,
/// or exceed the budget. Allocates at most 4,096 bytes per input byte, plus 512 KiB for the
/// probabilities.
LatticeTexture decode_compressed_texels(std::span<const std::byte> bytes, std::size_t faces,
                                        const std::string& file,
                                        MemoryBudget budget = MemoryBudget());

}  // namespace tureen
