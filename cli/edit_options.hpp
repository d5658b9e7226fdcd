// Changes to a scene's data on the command line.
#pragma once

#include "cli/arguments.hpp"
#include "soup/edits.hpp"

namespace tureen::cli {

/// --lattice-level, --color and --texel-bits. `edits` must live until the arguments are parsed.
void add_edit_options(Command& command, Edits& edits);

}  // namespace tureen::cli
