// The help text of --max-memory, for `tureen` and for the viewer.
#pragma once

namespace tureen {

inline constexpr const char* max_memory_help =
    "memory limit for reading each scene or dataset, 4 GiB by default; photographs beyond half of "
    "it "
    "go to a temporary file (in TMPDIR, or /var/tmp), a scene that needs more is rejected";

}  // namespace tureen
