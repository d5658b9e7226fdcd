// --max-memory, for every command that reads scenes or datasets.
#pragma once

#include <cstdint>
#include <functional>

#include "cli/options/arguments.hpp"

namespace tureen::cli {

/// Sets the memory limit for reading (base/memory_budget.hpp) when the option is parsed. `also`:
/// receives the bytes; may be empty.
void add_memory_option(Command& command, std::function<void(std::uint64_t)> also = {});

}  // namespace tureen::cli
