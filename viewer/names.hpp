// Short names of paths for the window.
#pragma once

#include <filesystem>
#include <span>
#include <string>

namespace tureen::viewer {

/// "soup.glb"; the folder's name if the path ends with a slash.
inline std::string short_name(const std::filesystem::path& path) {
  return (path.has_filename() ? path : path.parent_path()).filename().string();
}

/// "soup.glb"; "soup.glb and 2 more". Needs at least one path.
inline std::string short_names(std::span<const std::filesystem::path> paths) {
  const std::string first = short_name(paths.front());
  return paths.size() == 1 ? first : first + " and " + std::to_string(paths.size() - 1) + " more";
}

}  // namespace tureen::viewer
