// Lattice texels on the device: eight interleaved channels become two stores of features and one of
// alpha, in the order that the plan asks for.
#pragma once

#include "runtime/plan.hpp"
#include "runtime/texel_store.hpp"

namespace tureen {

struct LatticeStores {
  TexelStore features0;  // f0..f3
  TexelStore features1;  // f4..f6, 0
  TexelStore alphas;
  TexelStore patches;  // (first texel, level) a slot
};

/// Makes only the stores that the plan reads: features1 with a network, alphas with cut-outs,
/// patches without a uniform level. Throws DeviceLimitError.
LatticeStores upload_lattice(const LatticeTexture& texture, const RenderPlan& plan,
                             const TexelLayout& layout);

}  // namespace tureen
