#include "viewer/render_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <string_view>
#include <utility>

#include "base/platform/process.hpp"
#include "scene/document/place_text.hpp"
#include "viewer/axes.hpp"

namespace tureen::viewer {

namespace {

/// The shortest texts that read back as the same doubles.
std::string list_of(const glm::dvec3& v) { return fmt::format("{},{},{}", v.x, v.y, v.z); }

void add_choice(std::string& command, const DrawingChoice& choice, const SceneSource& scene) {
  if (choice.pipeline == PipelineKind::baseline) command += " --pipeline baseline";
  if (!choice.plan.specialise) command += " --no-specialise";
  if (choice.plan.as_published) command += " --as-published";
  if (choice.plan.splat_blending != SplatBlending::automatic)
    command +=
        fmt::format(" --blend {}", splat_blending_names[std::size_t(choice.plan.splat_blending)]);
  std::string kept;
  for (const SpecialisationName& entry : specialisation_names())
    if (!choice.plan.specialisations.has(entry.what))
      kept += (kept.empty() ? "" : ",") + std::string(entry.name);
  if (choice.plan.specialise && !kept.empty()) command += " --keep " + kept;
  for (const std::string& argument : quality_arguments(scene, choice, "--scale"))
    command += " " + argument;
}

/// The layers that a command reads from the whole files.
struct ReadLayers {
  Scene scene;                               // without primitives
  std::vector<const DocumentLayer*> layers;  // as the document has them; null if removed

  explicit ReadLayers(const SceneSource& source) {
    std::vector<Scene> headers;
    for (std::size_t file = 0; file < source.files.size(); ++file) {
      if (!has_layers(source, file)) continue;
      headers.push_back(*source.files[file].header);
      for (std::size_t i = 0; i < headers.back().layers.size(); ++i) {
        layers.push_back(nullptr);
        for (const DocumentLayer& layer : source.document.layers)
          if (const LayerOrigin& origin = source.origins.at(layer.id);
              origin.file == file && origin.index == i)
            layers.back() = &layer;
      }
    }
    if (!headers.empty()) scene = merged(std::move(headers));
  }

  /// A name that no other layer has.
  std::string name(std::size_t index) const {
    std::string own = tureen::label(scene.layers[index], index);
    const auto same = std::count_if(scene.layers.begin(), scene.layers.end(),
                                    [&](const Layer& layer) { return layer.name == own; });
    return same > 1 ? tureen::label({}, index) : own;
  }
};

/// The options of rays: the profile, the samples, and the surfaces of layers where they are not
/// those of the files.
void add_rays(std::string& command, const DrawingChoice& choice, const SceneSource& scene,
              int rays) {
  command += " --renderer trace";
  DrawingChoice own;  // rays have no other quality
  own.plan.splat_profile = choice.plan.splat_profile;
  own.quality = Quality{.splat_order = scene.scene->quality.splat_order};
  for (const std::string& argument : quality_arguments(scene, own, "--scale"))
    command += " " + argument;
  if (rays > 1) command += fmt::format(" --samples {}", rays);
  const ReadLayers read(scene);
  for (std::size_t i = 0; i < read.layers.size(); ++i) {
    const DocumentLayer* const layer = read.layers[i];
    if (!layer || !layer->material || layer->material == read.scene.layers[i].material) continue;
    const std::string surface =
        is_glass(*layer->material) ? fmt::format("glass:{}", layer->material->ior) : "mirror";
    command += " --material " + shell_word(read.name(i) + "=" + surface);
  }
}

/// "depth"; "features:0" and "features:4-6" for a choice of them.
std::string shown(const DebugViewChoice& debug_view) {
  std::string name = name_of(debug_view.what);
  if (debug_view.what != DebugView::features) return name;
  const int first = debug_view.features.first, last = first + debug_view.features.count - 1;
  name += fmt::format(":{}", first);
  if (last > first) name += fmt::format("-{}", last);
  return name;
}

}  // namespace

std::string quoted_command(const std::vector<std::string>& arguments) {
  std::string command = "tureen";
  for (const std::string& argument : arguments) command += " " + shell_word(argument);
  return command;
}

std::filesystem::path path_for_command(const std::filesystem::path& path) {
  namespace fs = std::filesystem;
  std::error_code unknown;
  const fs::path whole = fs::absolute(path, unknown).lexically_normal();
  const fs::path below = whole.lexically_relative(fs::current_path(unknown));
  return unknown || below.empty() || *below.begin() == ".." ? whole : path;
}

std::vector<std::string> place_arguments(const SceneSource& scene) {
  if (scene.is_as_read()) return {};
  const ReadLayers read(scene);
  // Without the first file, the others would be turned upright for another one.
  const bool all = !has_layers(scene, 0);
  std::vector<std::string> arguments;
  for (std::size_t i = 0; i < read.layers.size(); ++i) {
    const Layer& from = read.scene.layers[i];
    const DocumentLayer* const layer = read.layers[i];
    const bool visible = layer && layer->visible;
    const glm::dmat4& place = layer ? layer->world_from_layer : from.world_from_layer;
    if (!all && place == from.world_from_layer && visible == from.visible) continue;
    arguments.emplace_back("--place");
    arguments.push_back(place_text(read.name(i), similarity_of(place), visible));
  }
  return arguments;
}

std::vector<std::string> quality_arguments(const SceneSource& scene, const DrawingChoice& choice,
                                           const char* resolution_scale) {
  std::vector<std::string> arguments;
  const auto add = [&](const char* option, std::string value) {
    arguments.emplace_back(option);
    arguments.push_back(std::move(value));
  };
  const Quality quality = quality_of(choice, *scene.scene), own = scene.scene->quality;
  if (has_splats(scene)) {
    if (const auto& profile = choice.plan.splat_profile)
      add("--profile", std::string(name_of(*profile)));
    if (quality.splat_order != own.splat_order)
      add("--splat-order", std::string(name_of(quality.splat_order)));
  }
  if (quality.resolution_scale == own.resolution_scale &&
      quality.supersampling == own.supersampling)
    return arguments;
  if (quality.resolution_scale < 1)
    add(resolution_scale, fmt::format("{}", quality.resolution_scale));
  else
    add("--supersample", std::to_string(quality.supersampling));
  return arguments;
}

bool needs_camera_file(const Camera& camera) {
  // A camera of look_at has one focal length and its principal point in the middle. Half a
  // thousandth of a pixel is far below the 1/256 that vertices snap to.
  constexpr double pixels = 0.0005;
  return std::abs(camera.cx - 0.5 * camera.width) > pixels ||
         std::abs(camera.cy - 0.5 * camera.height) > pixels ||
         std::abs(camera.fx / camera.fy - 1) * camera.width > pixels;
}

std::string render_command(const SceneSource& scene, const DrawingChoice& choice,
                           const DebugViewChoice& debug_view, const Camera& camera,
                           const std::filesystem::path& camera_file,
                           std::optional<std::uint64_t> max_splats, int rays) {
  std::string command = "tureen render";
  for (const std::filesystem::path& path : scene.paths())
    command += " " + shell_word(path_for_command(path).string());
  if (max_splats) command += fmt::format(" --max-splats {}", *max_splats);
  if (const auto lod = lod_of(scene)) command += fmt::format(" --lod {}", *lod);
  for (const std::string& argument : place_arguments(scene)) command += " " + shell_word(argument);
  if (needs_camera_file(camera)) {
    command += " --camera " + shell_word(camera_file.string());
  } else {
    const glm::dmat3 axes = camera.world_from_view_rotation();
    const glm::dvec3 eye = camera.eye();
    // Distance of the target, far enough that its digits give the direction as precisely as the
    // eye's digits give the position.
    const double reach = std::max(1.0, glm::length(eye));
    const double fov = 2 * std::atan2(0.5 * camera.height, camera.fy) * degrees_per_radian;
    command += " --eye " + list_of(eye) + " --target " + list_of(eye - reach * axes[2]) + " --up " +
               list_of(axes[1]) + fmt::format(" --fov {}", fov);
  }
  if (const glm::vec3 color = background_of(scene); color != scene.scene->info.background)
    command += " --background " + list_of(color);
  command += fmt::format(" --size {}x{}", camera.width, camera.height);
  if (debug_view.what != DebugView::color)
    command += " --debug-view " + shown(debug_view);
  else if (rays > 0)
    add_rays(command, choice, scene, rays);
  else
    add_choice(command, choice, scene);
  return command + " -o image.png";
}

}  // namespace tureen::viewer
