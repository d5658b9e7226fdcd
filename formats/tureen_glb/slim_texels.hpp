// Lattice textures in few bytes, with a loss that the caller sets: the texels of a slim file
// (docs/format.md, version 3).
//
// Features become values of a SlimBasis. Level by level, so that coarse data come first: the
// corners of a face are predicted from the face before it, each texel of a finer level as the mean
// of the two that it lies between. What the prediction misses is divided by a step and coded by a
// range coder whose probabilities depend on the channel, the level and what was missed nearby.
// Predictions are made from what the decoder has, so errors never add up: where bits have no price
// a value is off by half a step at most, however fine its level. Where they have one the encoder
// weighs each error against the bits that it saves (rate-distortion optimised quantisation). A face
// that is smooth on a level takes next to nothing for it.
//
// Nothing that nobody sees is kept: features where no alpha around reaches 1/2, and alpha where
// everything around is on one side of 1/2 but for the side.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/memory_budget.hpp"
#include "formats/tureen_glb/slim_basis.hpp"
#include "scene/triangle_soup.hpp"

namespace tureen {

/// Quarters, by which a face's steps of features are multiplied.
inline constexpr std::array<std::uint8_t, 8> slim_multipliers{2, 3, 4, 6, 8, 12, 16, 32};
/// The index of the multiplier that changes nothing.
inline constexpr std::uint8_t one_step = 2;

/// How much a texel may be off. The defaults lose nothing that shows.
struct SlimTexelOptions {
  SlimBasis basis = SlimBasis::identity();
  /// Values of the basis a step, 1..255; alphas a step, 1..127.
  std::uint8_t feature_step = 1;
  std::uint8_t alpha_step = 1;
  /// Of each face: an index into slim_multipliers. Empty: one_step for all. Faces that share texels
  /// get the smaller one.
  std::vector<std::uint8_t> coarseness = {};
  /// Values that do not show are kept as well as those that do.
  bool keep_hidden = false;
  /// How much a squared error of a feature counts, one a texel of the texture, at least 0. Empty: 1
  /// for all. Texels of equal patches get the larger one.
  std::vector<float> weights = {};
  /// How many squared feature steps, times their weight, a value on the finest level of its patch
  /// may be off further to take a bit less, at least 0; on coarser levels errors count more. None:
  /// each is the nearest multiple of its step.
  double bit_price = 0;
};

/// The texture's patches and texels as bytes; float texels are rounded to bytes first. Equal
/// patches are stored once. The texture has no defect(). Throws UsageError
/// for more than 2^32 texels.
std::vector<std::byte> encode_slim_texels(const LatticeTexture& texture,
                                          const SlimTexelOptions& options);

/// What encode_slim_texels made them of, without a color MLP: byte texels, patches in the order of
/// their first face. Throws InputError, which names `file`, for bytes that were cut short or hold
/// another number of faces, or take more memory than the budget has left. At most 4,096 bytes are
/// allocated for each one that is there, and half a mebibyte for the probabilities.
LatticeTexture decode_slim_texels(std::span<const std::byte> bytes, std::size_t faces,
                                  const std::string& file, MemoryBudget budget = MemoryBudget());

}  // namespace tureen
