// --max-memory, of every command that reads scenes or datasets.
#pragma once

#include "cli/options/arguments.hpp"

namespace tureen::cli {

/// Sets what reading may take (base/memory_budget.hpp) as soon as the option is parsed.
void add_memory_option(Command& command);

}  // namespace tureen::cli
