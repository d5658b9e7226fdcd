// --max-memory, for every command that reads scenes or datasets.
#pragma once

#include "cli/options/arguments.hpp"

namespace tureen::cli {

/// Sets the memory limit for reading (base/memory_budget.hpp) when the option is parsed.
void add_memory_option(Command& command);

}  // namespace tureen::cli
