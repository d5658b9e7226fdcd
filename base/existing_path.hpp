// Whether a path exists, and if not, the reason.
#pragma once

#include <filesystem>

#include "base/input.hpp"

namespace tureen {

/// Whether nothing exists at `path`. False if the lookup itself is denied: opening reports the
/// reason.
bool is_missing(const std::filesystem::path& path);

/// Throws InputError with the reason if nothing exists at `path` (missing folder, broken link,
/// similar name). Throws InputError too if the lookup is denied or a folder cannot be entered.
/// Throws UsageError if the path is empty.
void require_there(const std::filesystem::path& path);

/// Opens the file at `path`. Throws as require_there() and Input::open().
Input open_existing(const std::filesystem::path& path);

/// Whether `path` is `folder` or lies below it, with links followed. Neither has to exist. False
/// for a path that cannot be looked up.
bool lies_in(const std::filesystem::path& path, const std::filesystem::path& folder);

}  // namespace tureen
