// What the window remembers between runs, under the folders that desktops have for that (XDG base
// directories): a JSON file that a person may edit.
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <vector>

namespace tureen::viewer {

struct Settings {
  glm::ivec2 window{1280, 800};  // in points
  bool vsync = true;
  bool smooth_motion = true;
  std::vector<std::string> recent;  // scenes, the newest first; at most most_recent
  std::string images;               // the folder of screenshots; empty: images_folder()
};

inline constexpr std::size_t most_recent = 12;

/// $XDG_CONFIG_HOME/tureen/viewer.json, or that under ~/.config; nothing without a home.
std::optional<std::filesystem::path> settings_file();

/// $XDG_PICTURES_DIR or ~/Images where they are there, or else the current folder.
std::filesystem::path images_folder();

/// Defaults where there is no file. What the file lacks is at its default. Throws InputError for
/// one that is not ours.
Settings read_settings(const std::filesystem::path& file);

/// Whole or not at all, with its folder. Throws OutputError.
void write_settings(const Settings& settings, const std::filesystem::path& file);

/// Puts a scene at the head of those that were opened lately.
void remember(Settings& settings, const std::filesystem::path& scene);

}  // namespace tureen::viewer
