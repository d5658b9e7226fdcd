// Whether something lies at a path that a person named, and why it cannot be had where it does not.
#pragma once

#include <filesystem>

namespace tureen {

/// Whether nothing lies there. What may not be looked up is not missing: opening it says why.
bool is_missing(const std::filesystem::path& path);

/// Throws an InputError with the reason where nothing lies at `path` (a folder that is not there, a
/// link that leads nowhere, a name that is close), or where it may not be looked up or, if it is a
/// folder, entered. Throws UsageError where the path is empty.
void require_there(const std::filesystem::path& path);

/// Whether `path` is `folder` or lies below it, wherever links lead. Neither need be there; what
/// cannot be looked up lies nowhere.
bool lies_in(const std::filesystem::path& path, const std::filesystem::path& folder);

}  // namespace tureen
