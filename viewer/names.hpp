// Short names of paths for the window.
#pragma once

#include <filesystem>
#include <string>

namespace tureen::viewer {

/// "soup.glb"; the folder's name if the path ends with a slash.
inline std::string short_name(const std::filesystem::path& path) {
  return (path.has_filename() ? path : path.parent_path()).filename().string();
}

}  // namespace tureen::viewer
