// Lattice texels on the device: eight interleaved channels become two stores of features, in the
// order that the plan asks for, and one of alpha by lattice cell.
#pragma once

#include "runtime/passes/texel_store.hpp"
#include "runtime/plan/plan.hpp"

namespace tureen {

struct LatticeSources {
  TexelSource features0;  // f0..f3
  TexelSource features1;  // f4..f6, 0
  /// Alpha at the four corners of each cell, so that an alpha test costs one read instead of three
  /// (docs/decisions/alpha-cells.md has the measurement); or, where the plan says so, of each
  /// texel.
  TexelSource alpha;
  TexelSource patches;  // (first texel, level, first cell, 0) a slot
};

/// Only what the plan reads: features1 where the network sees it, alpha with cut-outs,
/// patches without a uniform level; the others have no `fill`. All of them read `texture`, which
/// must outlive them. Throws DeviceLimitError.
LatticeSources prepare_lattice(const LatticeTexture& texture, const RenderPlan& plan,
                               const TexelLayout& layout);

}  // namespace tureen
