// The help text of --max-memory, for `tureen` and for the viewer.
#pragma once

namespace tureen {

inline constexpr const char* max_memory_help =
    "what reading a scene or a dataset may take, 4GB by default: a file that asks for more is "
    "refused";

}  // namespace tureen
