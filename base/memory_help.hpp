// What --max-memory is, for the help of every program that has it: `tureen` and the window.
#pragma once

namespace tureen {

inline constexpr const char* max_memory_help =
    "what reading a scene or a dataset may take, 4GB by default: a file that asks for more is "
    "refused";

}  // namespace tureen
