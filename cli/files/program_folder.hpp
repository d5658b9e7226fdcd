// Where the running program lies: what belongs to it lies beside it.
#pragma once

#include <filesystem>
#include <optional>

namespace tureen::cli {

/// Links resolved; nothing where the system does not tell.
std::optional<std::filesystem::path> program_folder();

}  // namespace tureen::cli
