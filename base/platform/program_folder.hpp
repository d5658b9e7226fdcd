// The folder of the running program, near which its data files are.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace tureen {

/// With links resolved; empty if the system does not report it.
std::optional<std::filesystem::path> program_folder();

/// The program `name`: the path beside this one, otherwise the name alone, for a search on PATH.
std::string program_beside(const std::string& name);

}  // namespace tureen
