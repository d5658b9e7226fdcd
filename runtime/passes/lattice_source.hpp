// Lattice texels for the device: eight interleaved channels become two stores of features, in the
// plan's order, and one of alpha by lattice cell.
#pragma once

#include "runtime/passes/texel_store.hpp"
#include "runtime/plan/plan.hpp"

namespace tureen {

struct LatticeSources {
  TexelSource features0;  // f0..f3
  TexelSource features1;  // f4..f6, 0
  /// Alpha at the four corners of each cell, so that an alpha test needs one read instead of three
  /// (docs/decisions/alpha-cells.md has the measurement). If the plan requests it, alpha by texel.
  TexelSource alpha;
  TexelSource patches;  // (first texel, level, first cell, 0) a slot
};

/// Creates only the sources that the plan reads: features1 if the network uses it, alpha for
/// cut-outs, patches without a uniform level. The others have no `fill`. All read `texture`, which
/// must outlive them. Throws DeviceLimitError.
LatticeSources prepare_lattice(const LatticeTexture& texture, const SoupPlan& plan,
                               const TexelLayout& layout);

}  // namespace tureen
