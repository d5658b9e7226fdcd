// The help text of --max-memory, for `tureen` and for the viewer.
#pragma once

namespace tureen {

inline constexpr const char* max_memory_help =
    "memory limit for reading files, 4 GiB by default; a file that needs more is rejected";

}  // namespace tureen
