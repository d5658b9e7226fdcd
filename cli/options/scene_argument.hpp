// A scene named on the command line, read with progress.
#pragma once

#include <filesystem>
#include <string>

#include "cli/options/arguments.hpp"
#include "formats/scene_file.hpp"

namespace tureen::cli {

struct SceneArgument {
  std::string path;
  VertexColorSpace vertex_colors = VertexColorSpace::automatic;
  std::string up;  // empty: the scene's own
};

/// Adds the required argument `name`, and --vertex-colors and --up. `argument` must live until the
/// arguments are parsed.
void add_scene_argument(Command& command, SceneArgument& argument, const char* name = "SCENE");

/// Throws InputError, with a suggestion if the path does not exist.
Scene read(const SceneArgument& argument);

/// Size in bytes of a file, or of all files in a folder; files that cannot be read count as 0.
std::uint64_t bytes_on_disk(const std::filesystem::path& path);

}  // namespace tureen::cli
