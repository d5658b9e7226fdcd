// Options that change a stored scene: edits of its data, and its quality setting.
#pragma once

#include <optional>

#include "cli/options/arguments.hpp"
#include "scene/edit/edits.hpp"
#include "scene/quality.hpp"

namespace tureen::cli {

/// --lattice-level, --color and --texel-bits. `edits` must live until the arguments are parsed.
void add_edit_options(Command& command, Edits& edits);

/// Quality settings to store; empty without the option.
struct QualityOptions {
  std::optional<Quality> sampling;  // its splat order is not used
  std::optional<Quality::SplatOrder> splat_order;

  bool any() const { return sampling || splat_order; }
  void apply_to(Quality& quality) const;
};

/// --supersample, --resolution-scale and --splat-order.
void add_quality_options(Command& command, QualityOptions& quality);

}  // namespace tureen::cli
