// The window's settings, stored between runs in a JSON file that people can edit. Its folder
// follows the XDG base directories.
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <vector>

#include "viewer/gui/theme.hpp"

namespace tureen::viewer {

struct Settings {
  Theme theme = Theme::dark;
  glm::ivec2 window{1280, 800};  // in points
  bool vsync = true;
  bool smooth_motion = true;
  bool smooth_at_rest = true;       // Renderer::refine(), and images with its samples
  std::vector<std::string> recent;  // scenes, latest first; at most most_recent
  std::string images;               // folder for images; empty: images_folder()
};

inline constexpr std::size_t most_recent = 12;

/// $XDG_CONFIG_HOME/tureen/viewer.json, otherwise ~/.config/tureen/viewer.json, or nullopt without
/// HOME.
std::optional<std::filesystem::path> settings_file();

/// $XDG_PICTURES_DIR or ~/Pictures if it exists, otherwise the current folder.
std::filesystem::path images_folder();

/// Settings that the file lacks have their defaults; so have all without a file. Throws InputError
/// for an invalid file.
Settings read_settings(const std::filesystem::path& file);

/// Writes the complete file or nothing, and creates its folder. Throws OutputError.
void write_settings(const Settings& settings, const std::filesystem::path& file);

/// Moves a scene to the front of the recent ones.
void remember(Settings& settings, const std::filesystem::path& scene);

}  // namespace tureen::viewer
