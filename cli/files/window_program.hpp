// The program tureen-view. It is separate, so that this one needs no window libraries.
#pragma once

#include <string>
#include <vector>

#include "cli/exit_code.hpp"

namespace tureen::cli {

/// Replaces this process by the window program. Throws UsageError if it is not found, and
/// OutputError if it cannot be started.
ExitCode become_window(const std::vector<std::string>& arguments);

/// Starts the window program and does not wait for it. It prints only errors. Throws the same.
void start_window(const std::vector<std::string>& arguments);

}  // namespace tureen::cli
