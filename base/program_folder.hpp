// The folder of the running program, near which its data files are.
#pragma once

#include <filesystem>
#include <optional>

namespace tureen {

/// With links resolved; empty if the system does not report it.
std::optional<std::filesystem::path> program_folder();

}  // namespace tureen
