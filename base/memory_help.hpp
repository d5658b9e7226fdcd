// The help text of --max-memory, for `tureen` and for the viewer.
#pragma once

namespace tureen {

inline constexpr const char* max_memory_help =
    "memory limit per scene or dataset, 4 GiB by default. Photographs beyond half of it go to a "
    "temporary file in TMPDIR or /var/tmp; larger scenes are rejected";

}  // namespace tureen
