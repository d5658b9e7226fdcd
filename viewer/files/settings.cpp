#include "viewer/files/settings.hpp"

#include <algorithm>
#include <cstdlib>
#include <glm/common.hpp>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "base/input.hpp"
#include "base/json/json_file.hpp"
#include "base/output.hpp"

namespace tureen::viewer {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// A folder from an environment variable. The XDG specification requires that relative paths are
/// ignored.
std::optional<fs::path> folder_of(const char* variable) {
  const char* value = std::getenv(variable);
  if (!value || !fs::path(value).is_absolute()) return std::nullopt;
  return value;
}

template <class T>
void take(const Json& object, const char* key, T& value, const std::string& file) {
  const auto found = object.find(key);
  if (found == object.end()) return;
  try {
    found->get_to(value);
  } catch (const Json::exception&) {
    throw InputError({file, {}, {}}, std::string(key) + " has the wrong type");
  }
}

/// Smallest and largest window, in points.
constexpr glm::vec2 min_window{320, 240}, max_window{16384, 16384};

}  // namespace

std::optional<fs::path> settings_file() {
  std::optional<fs::path> folder = folder_of("XDG_CONFIG_HOME");
  if (const auto home = folder_of("HOME"); !folder && home) folder = *home / ".config";
  if (!folder) return std::nullopt;
  return *folder / "tureen" / "viewer.json";
}

fs::path images_folder() {
  std::error_code ignored;
  if (const auto folder = folder_of("XDG_PICTURES_DIR");
      folder && fs::is_directory(*folder, ignored))
    return *folder;
  if (const auto home = folder_of("HOME"); home && fs::is_directory(*home / "Pictures", ignored))
    return *home / "Pictures";
  return ".";
}

Settings read_settings(const fs::path& file) {
  Settings settings;
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return settings;
  Input input = Input::open(file);
  const Json json = read_json(input);
  const std::string name = file.string();
  if (!json.is_object()) throw InputError({name, {}, {}}, "the file is not a JSON object");
  if (std::string theme; json.contains("theme")) {
    take(json, "theme", theme, name);
    const auto found = std::find(theme_names.begin(), theme_names.end(), theme);
    if (found == theme_names.end())
      throw InputError({name, {}, {}}, "theme is neither \"dark\" nor \"light\"");
    settings.theme = Theme(found - theme_names.begin());
  }
  if (const auto window = json.find("window"); window != json.end()) {
    // Clamped as floats, because an int cannot hold every number.
    const std::vector<float> sides = json_floats(*window, 2, name, "window");
    settings.window = glm::clamp(glm::vec2(sides[0], sides[1]), min_window, max_window);
  }
  take(json, "vsync", settings.vsync, name);
  take(json, "smooth_motion", settings.smooth_motion, name);
  take(json, "smooth_at_rest", settings.smooth_at_rest, name);
  take(json, "recent", settings.recent, name);
  settings.recent.resize(std::min(settings.recent.size(), most_recent));
  take(json, "pictures", settings.images, name);
  return settings;
}

void write_settings(const Settings& settings, const fs::path& file) {
  const Json json = {{"theme", theme_names[std::size_t(settings.theme)]},
                     {"window", {settings.window.x, settings.window.y}},
                     {"vsync", settings.vsync},
                     {"smooth_motion", settings.smooth_motion},
                     {"smooth_at_rest", settings.smooth_at_rest},
                     {"recent", settings.recent},
                     {"pictures", settings.images}};
  make_folder(file.parent_path());
  // File names may contain any bytes.
  write_file(file, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

void remember(Settings& settings, const fs::path& scene) {
  std::error_code ignored;
  fs::path path = fs::absolute(scene, ignored).lexically_normal();
  if (!path.has_filename()) path = path.parent_path();  // a folder with a trailing slash
  std::erase(settings.recent, path.string());
  settings.recent.insert(settings.recent.begin(), path.string());
  settings.recent.resize(std::min(settings.recent.size(), most_recent));
}

}  // namespace tureen::viewer
