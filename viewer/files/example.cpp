#include "viewer/files/example.hpp"

#include "base/platform/program_folder.hpp"

namespace tureen::viewer {

namespace {

namespace fs = std::filesystem;

std::optional<fs::path> find_example() {
  const std::optional<fs::path> folder = program_folder();
  if (!folder) return std::nullopt;
  std::error_code ignored;
  // Beside bin/ in builds, beside the program in a portable folder.
  for (const fs::path& file :
       {folder->parent_path() / "share/tureen/example.glb", *folder / "examples/soup.glb"})
    if (fs::is_regular_file(file, ignored)) return file;
  return std::nullopt;
}

}  // namespace

const std::optional<fs::path>& example_scene() {
  static const std::optional<fs::path> found = find_example();  // the window asks in every frame
  return found;
}

}  // namespace tureen::viewer
