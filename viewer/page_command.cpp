#include "viewer/page_command.hpp"

#include <fmt/format.h>

#include "viewer/axes.hpp"

namespace tureen::viewer {

std::vector<std::string> page_arguments(const StageSource& scene, const PageRequest& request,
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
  if (const auto& profile = request.choice.plan.splat_profile)
    add("--profile", std::string(name_of(*profile)));
  const Quality quality = quality_of(request.choice, *scene.scene), own = scene.scene->quality;
  if (quality.splat_order != own.splat_order)
    add("--splat-order", std::string(name_of(quality.splat_order)));
  if (quality.resolution_scale < 1 && quality.resolution_scale != own.resolution_scale)
    add("--resolution-scale", fmt::format("{}", quality.resolution_scale));
  else if (quality.resolution_scale == 1 &&
           (own.resolution_scale < 1 || quality.supersampling != own.supersampling))
    add("--supersample", std::to_string(quality.supersampling));
  return arguments;
}

}  // namespace tureen::viewer
