#include "web/engine/scene_path.hpp"

namespace tureen::web {

std::filesystem::path scene_path(const Json& arguments) {
  std::filesystem::current_path(arguments.at("folder").get<std::string>());
  const Json& paths = arguments.at("paths");
  for (const Json& path : paths)
    if (is_scene(path.get<std::string>())) return path.get<std::string>();
  return paths.back().get<std::string>();
}

ReadOptions read_options(const Json& arguments) {
  ReadOptions options;
  if (const auto max = arguments.find("max_splats"); max != arguments.end())
    options.max_splats = max->get<std::uint64_t>();
  if (const auto lod = arguments.find("lod"); lod != arguments.end())
    options.lod = lod->get<std::size_t>();
  return options;
}

}  // namespace tureen::web
