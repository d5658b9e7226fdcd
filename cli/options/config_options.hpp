// The training constants on the command line (jobs/training/training_options.hpp).
#pragma once

#include "cli/options/arguments.hpp"
#include "jobs/training/training_options.hpp"

namespace tureen::cli {

/// --method, --config, --steps, --seed and --init, and the options that methods list, in groups by
/// method. `options` must live until the arguments are parsed.
void add_config_options(Command& command, TrainingOptions& options);

}  // namespace tureen::cli
