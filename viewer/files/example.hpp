// The example scene that comes with the program.
#pragma once

#include <filesystem>
#include <optional>

namespace tureen::viewer {

/// Its path; nullopt if it is not near the program.
const std::optional<std::filesystem::path>& example_scene();

}  // namespace tureen::viewer
