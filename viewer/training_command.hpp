// The command that trains a scene from photographs.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tureen::viewer {

/// A path beside the dataset, absolute, that no scene and no unfinished run has: fox.glb,
/// fox-2.glb.
std::filesystem::path new_trained_scene(const std::filesystem::path& dataset);

/// The arguments of `tureen` that train `scene` from the dataset, with a window that shows it.
std::vector<std::string> training_arguments(const std::filesystem::path& dataset,
                                            const std::filesystem::path& scene);

/// The command that continues this training from its checkpoint; empty if there is none.
std::string command_that_continues(const std::filesystem::path& dataset,
                                   const std::filesystem::path& scene);

}  // namespace tureen::viewer
