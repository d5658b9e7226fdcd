#include "viewer/page_command.hpp"

#include <fmt/format.h>

#include "viewer/axes.hpp"
#include "viewer/render_command.hpp"

namespace tureen::viewer {

std::vector<std::string> page_arguments(const SceneSource& scene, const PageRequest& request,
                                        const std::filesystem::path& page) {
  std::error_code unknown;
  std::vector<std::string> arguments{"convert"};
  for (const std::filesystem::path& path : scene.paths())
    arguments.push_back(std::filesystem::absolute(path, unknown).string());
  const auto add = [&](const char* option, const std::string& value) {
    arguments.emplace_back(option);
    arguments.push_back(value);
  };
  add("-o", page.string());
  if (!is_axis(request.up, scene.subject.up))
    add("--up", fmt::format("{},{},{}", request.up.x, request.up.y, request.up.z));
  if (request.max_splats) add("--max-splats", std::to_string(*request.max_splats));
  if (const auto lod = lod_of(scene)) add("--lod", std::to_string(*lod));
  if (request.max_memory != default_max_memory)
    add("--max-memory", std::to_string(request.max_memory));
  if (!request.view.empty()) add("--view", request.view.string());
  for (const std::string& argument : place_arguments(scene)) arguments.push_back(argument);
  const auto quality = quality_arguments(scene, request.choice, "--resolution-scale");
  arguments.insert(arguments.end(), quality.begin(), quality.end());
  return arguments;
}

}  // namespace tureen::viewer
