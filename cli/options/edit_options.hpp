// Options that change a stored scene: edits of its data, and its quality setting.
#pragma once

#include <optional>

#include "cli/options/arguments.hpp"
#include "scene/edit/edits.hpp"
#include "scene/quality.hpp"

namespace tureen::cli {

/// --lattice-level, --color and --texel-bits. `edits` must live until the arguments are parsed.
void add_edit_options(Command& command, Edits& edits);

/// --supersample and --resolution-scale. `quality` stays empty without them.
void add_quality_options(Command& command, std::optional<Quality>& quality);

}  // namespace tureen::cli
