// What --max-memory is, for the help of every program that has it: `tureen` and the window.
#pragma once

namespace tureen {

inline constexpr const char* max_memory_help =
    "memory limit for reading a scene or a dataset, 4GB by default; a file that needs more is "
    "rejected";

}  // namespace tureen
