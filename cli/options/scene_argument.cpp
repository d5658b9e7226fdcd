#include "cli/options/scene_argument.hpp"

#include <fmt/format.h>

#include <glm/geometric.hpp>
#include <utility>

#include "base/error.hpp"
#include "base/existing_path.hpp"
#include "cli/options/output_argument.hpp"
#include "cli/options/values.hpp"
#include "cli/progress.hpp"
#include "cli/report.hpp"
#include "scene/document/place_text.hpp"
#include "scene/edit/baked_transform.hpp"
#include "scene/near_limit.hpp"

namespace tureen::cli {

namespace {

constexpr char scene_help[] = "scene: a file or a folder; its content determines the format";

/// The name of the file without its extension, or of the folder.
std::string stem_of(const std::string& path) {
  const std::filesystem::path normal = std::filesystem::path(path).lexically_normal();
  return (normal.has_filename() ? normal : normal.parent_path()).stem().string();
}

Scene read_file(const std::string& name, const ReadingChoice& choice) {
  glm::dvec3 up(0.0);
  if (!choice.up.empty()) {
    up = parse_direction(choice.up);
    if (!(glm::length(up) > 0)) throw UsageError("--up 0,0,0 has no direction");
  }
  const std::filesystem::path path = name;
  require_there(path);
  Progress progress("reading " + path.filename().string());
  ReadOptions options;
  options.vertex_colors = choice.vertex_colors;
  options.octagon_q = choice.octagon_q;
  options.max_splats = choice.max_splats;
  options.lod = choice.lod;
  options.keep_rows = choice.keep_rows;
  options.progress = [&](double fraction) { progress.update(fraction); };
  Scene scene = read_scene(path, options);
  if (!choice.up.empty()) choose_up(scene.info, glm::vec3(glm::normalize(up)));
  return scene;
}

/// The choices that need all layers.
void apply(const ReadingChoice& choice, Scene& scene) {
  if (!choice.profile.empty()) choose_profile(scene, choice.profile);
  if (choice.near_limit) choose_near_limit(scene, *choice.near_limit);
  std::vector<PlaceChange> places;
  for (const std::string& text : choice.places) places.push_back(parse_place(text));
  place_layers(scene, places);
}

}  // namespace

void add_reading_options(Command& command, ReadingChoice& choice) {
  add_choice<VertexColorSpace>(command, "--vertex-colors SPACE", choice.vertex_colors,
                               {{"auto", VertexColorSpace::automatic},
                                {"srgb", VertexColorSpace::srgb},
                                {"linear", VertexColorSpace::linear}},
                               "colour space of COLOR_0 in a foreign glTF: auto (default: by its "
                               "generator), srgb or linear");
  command.add_option("--up AXIS", choice.up,
                     "up direction in world coordinates: x, -y, z .. or X,Y,Z; the scene's own by "
                     "default");
  command.add_option(
      "--octagon-q Q", choice.octagon_q,
      "value of --quant with which REdiSplats' generate_mesh.py wrote an .npz: its corners are at "
      "sqrt(Q) standard deviations; 4 by default, others are 6.2514, 7.8147, 11.3449 and 21.1075",
      between(0.001, 1000.0));
  command.add_option(
      "--max-splats N", choice.max_splats,
      "read at most N splats from each scene, those with the largest opacity times area",
      between(1.0, 4294967295.0));
  command.add_option("--lod N", choice.lod,
                     "level of detail of a streamed SOG, 0 for the finest; by default the finest "
                     "that fits --max-splats and --max-memory",
                     between(0.0, 63.0));
  std::vector<std::string> names;
  for (const NamedProfile& each : named_profiles) names.emplace_back(each.name);
  add_word_option(
      command, "--profile NAME", names,
      [&choice](std::size_t index) { choice.profile = named_profiles[index].name; },
      fmt::format("draw splats by the rules of another method: {}; the scene's own by default",
                  fmt::join(names, ", ")));
  command.add_option("--near-limit UNITS", choice.near_limit,
                     "do not draw splats whose centres have at most this view depth; the scene's "
                     "own by default, 0.2 in the published rules",
                     between(0.0, 1e30));
}

void add_placing_options(Command& command, ReadingChoice& choice) {
  command
      .add_option("--place NAME=PARTS", choice.places,
                  "place, hide or show a layer; once per layer. PARTS are separated by slashes: "
                  "at:X,Y,Z, turn:X,Y,Z (degrees about x, then y, then z; replaces the turn to the "
                  "common up axis), scale:FACTOR, mirror or mirror:no, hidden or visible. Omitted "
                  "parts do not change; info prints names and places",
                  [](const std::string& text) {
                    parse_place(text);
                    return std::string();
                  })
      .repeatable();
  command.add_flag(
      "--keep-axes", [&choice] { choice.up_axes = UpAxes::keep; },
      "do not turn scenes whose up axis differs from the first scene's");
}

void add_scene_argument(Command& command, SceneArgument& argument) {
  command.add_option("SCENE", argument.path, scene_help).required();
  add_reading_options(command, argument.choice);
}

void add_scene_arguments(Command& command, SceneArguments& arguments) {
  command
      .add_option(
          "SCENE", arguments.paths,
          std::string(scene_help) + ". Several scenes are combined into one, each as a layer")
      .required();
  add_reading_options(command, arguments.choice);
}

Scene read(const SceneArgument& argument) {
  Scene scene = read_file(argument.path, argument.choice);
  apply(argument.choice, scene);
  return scene;
}

Scene read_one_layer(const SceneArgument& argument) {
  Scene scene = read(argument);
  bake_transform(only_layer(scene));
  return scene;
}

Scene read(const SceneArguments& arguments) {
  std::vector<Scene> scenes;
  for (const std::string& path : arguments.paths) {
    Scene& scene = scenes.emplace_back(read_file(path, arguments.choice));
    if (arguments.paths.size() > 1 && scene.info.name.empty()) scene.info.name = stem_of(path);
  }
  Scene scene = merged(std::move(scenes), arguments.choice.up_axes);
  apply(arguments.choice, scene);
  return scene;
}

void require_not_inputs(const std::filesystem::path& output, const SceneArguments& arguments) {
  for (const std::string& path : arguments.paths) require_not_input(output, path);
}

void say_what_is_hidden(const Scene& scene) {
  if (!has_visible_layer(scene))
    say(scene.layers.size() == 1 ? "The only layer is hidden: images show only the background."
                                 : "All layers are hidden: images show only the background.");
  for (std::size_t i = 0; i < scene.layers.size(); ++i)
    if (const auto* splats = std::get_if<Splats>(&scene.layers[i].primitives);
        splats && is_transparent(*splats))
      say("All splats of " + label(scene.layers[i], i) + " are transparent: none is drawn.");
}

std::string listed(const SceneArguments& arguments) {
  return fmt::format("{}", fmt::join(arguments.paths, ", "));
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

std::uint64_t bytes_on_disk(const SceneArguments& arguments) {
  std::uint64_t total = 0;
  for (const std::string& path : arguments.paths) total += bytes_on_disk(path);
  return total;
}

}  // namespace tureen::cli
