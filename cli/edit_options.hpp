// Changes to a scene's data on the command line.
#pragma once

#include <CLI/App.hpp>

#include "soup/edits.hpp"

namespace tureen::cli {

/// --lattice-level, --color and --texel-bits. `edits` must live until the arguments are parsed.
void add_edit_options(CLI::App& command, Edits& edits);

}  // namespace tureen::cli
