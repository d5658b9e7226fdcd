#include "cli/options/scene_argument.hpp"

#include <glm/geometric.hpp>

#include "base/error.hpp"
#include "base/existing_path.hpp"
#include "cli/options/values.hpp"
#include "cli/progress.hpp"

namespace tureen::cli {

void add_scene_argument(Command& command, SceneArgument& argument, const char* name) {
  command
      .add_option(name, argument.path,
                  "scene: a file or a folder; its content determines the format")
      .required();
  add_choice<VertexColorSpace>(command, "--vertex-colors", argument.vertex_colors,
                               {{"auto", VertexColorSpace::automatic},
                                {"srgb", VertexColorSpace::srgb},
                                {"linear", VertexColorSpace::linear}},
                               "colour space of COLOR_0 in a foreign glTF: auto (default, depends "
                               "on its generator), srgb or linear")
      .value_name("SPACE");
  command
      .add_option("--up", argument.up,
                  "up direction in world coordinates; the scene's own by default")
      .value_name("X,Y,Z");
}

Scene read(const SceneArgument& argument) {
  glm::dvec3 up(0.0);
  if (!argument.up.empty()) {
    up = parse_vector(argument.up);
    if (!(glm::length(up) > 0)) throw UsageError("--up 0,0,0 has no direction");
  }
  const std::filesystem::path path = argument.path;
  require_there(path);
  Progress progress("reading " + path.filename().string());
  ReadOptions options;
  options.vertex_colors = argument.vertex_colors;
  options.progress = [&](double fraction) { progress.update(fraction); };
  Scene scene = read_scene(path, options);
  if (!argument.up.empty()) {
    scene.info.up = glm::vec3(glm::normalize(up));
    scene.info.up_is_assumed = false;
  }
  return scene;
}

std::uint64_t bytes_on_disk(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::is_directory(path, error)) {
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    return error ? 0 : size;
  }
  std::uint64_t total = 0;
  for (std::filesystem::recursive_directory_iterator it(path, error), end; !error && it != end;
       it.increment(error)) {
    std::error_code ignored;
    if (!it->is_regular_file(ignored)) continue;
    const std::uintmax_t size = it->file_size(ignored);
    if (!ignored) total += size;
  }
  return total;
}

}  // namespace tureen::cli
