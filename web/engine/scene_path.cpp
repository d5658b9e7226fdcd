#include "web/engine/scene_path.hpp"

#include "formats/scene_file.hpp"

namespace tureen::web {

std::filesystem::path scene_path(const Json& arguments) {
  std::filesystem::current_path(arguments.at("folder").get<std::string>());
  const Json& paths = arguments.at("paths");
  for (const Json& path : paths)
    if (is_scene(path.get<std::string>())) return path.get<std::string>();
  return paths.back().get<std::string>();
}

}  // namespace tureen::web
