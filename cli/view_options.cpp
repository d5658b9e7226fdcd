#include "cli/view_options.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <glm/geometric.hpp>

#include "cli/values.hpp"
#include "formats/camera_file.hpp"
#include "formats/scene_file.hpp"
#include "formats/suggestion.hpp"
#include "runtime/navigation.hpp"
#include "soup/error.hpp"

namespace tureen::cli {

namespace {

namespace fs = std::filesystem;

constexpr double radians_per_degree = 0.017453292519943295;
constexpr int most_orbit_views = 1000;

/// "FILE:N" split where N is a number or "all"; the whole text is the file where one of that name
/// exists, colon and all.
struct CameraArgument {
  fs::path file;
  std::string which;

  CameraArgument(const std::string& text, const std::string& which_without)
      : file(text), which(which_without) {
    std::error_code error;
    const std::size_t colon = text.rfind(':');
    if (fs::exists(file, error) || colon == std::string::npos) return;
    const std::string suffix = text.substr(colon + 1);
    const bool digits = !suffix.empty() && std::all_of(suffix.begin(), suffix.end(), [](char c) {
      return std::isdigit(static_cast<unsigned char>(c)) != 0;
    });
    if (!digits && suffix != "all") return;
    file = text.substr(0, colon);
    which = suffix;
  }
};

CameraFile cameras_in(const fs::path& file, const Scene& scene, const std::string& scene_path) {
  std::error_code error;
  if (!fs::exists(file, error)) throw InputError({file.string(), {}, {}}, why_missing(file));
  if (fs::equivalent(file, scene_path, error)) return {scene.cameras, {}};
  if (is_camera_file(file)) return read_cameras(file);
  return {read_scene(file).cameras, {}};
}

}  // namespace

Views recorded_views(const std::string& argument, const std::string& which_without,
                     const Scene& scene, const std::string& scene_path) {
  const CameraArgument wanted(argument, which_without);
  CameraFile found = cameras_in(wanted.file, scene, scene_path);
  if (found.cameras.empty())
    throw InputError({wanted.file.string(), {}, {}}, "it holds no cameras");
  if (wanted.which == "all") return {std::move(found.cameras), std::move(found.notes)};
  const int last = int(found.cameras.size()) - 1;
  // As text first: a number of forty digits is out of range, not malformed.
  if (wanted.which.size() > 9 || std::stol(wanted.which) > last)
    throw UsageError(argument + ": cameras are numbered from 0 to " + std::to_string(last));
  return {{found.cameras[std::size_t(std::stol(wanted.which))]}, std::move(found.notes)};
}

void add_view_options(CLI::App& command, ViewOptions& options) {
  command
      .add_option(
          "--size", options.size,
          "width and height in pixels, 1280x720 by default; a recorded camera keeps its own")
      ->option_text("WxH");
  auto* camera =
      command
          .add_option("--camera", options.camera,
                      "camera N (from 0) of a file, or all: our JSON of cameras, NeRF's "
                      "transforms.json, cameras.json of 3D Gaussian Splatting, the folder of a "
                      "COLMAP model, or a scene that has cameras, such as SCENE itself")
          ->option_text("FILE[:N|:all]");
  auto* eye = command
                  .add_option("--eye", options.eye,
                              "where the eye is, in world coordinates; it looks at --target")
                  ->option_text("X,Y,Z")
                  ->excludes(camera);
  command
      .add_option("--target", options.target,
                  "what the eye looks at; the centre of the scene by default")
      ->option_text("X,Y,Z")
      ->needs(eye);
  command
      .add_option("--fov", options.fov_degrees,
                  "the full vertical angle of view in degrees, 40 by default")
      ->option_text("DEGREES")
      ->check(CLI::Range(0.1, 179.0))
      ->excludes(camera);
  command
      .add_option("--orbit", options.orbit,
                  "so many views around the up axis, slightly from above, all of the scene in each")
      ->option_text("N")
      ->check(CLI::Range(1, most_orbit_views))
      ->excludes(camera)
      ->excludes(eye);
}

Views resolve_views(const ViewOptions& options, const Scene& scene, const std::string& scene_path) {
  std::optional<PictureSize> size;
  if (!options.size.empty()) size = parse_size(options.size);

  Views views;
  if (!options.camera.empty()) {
    views = recorded_views(options.camera, "0", scene, scene_path);
  } else if (options.eye.empty() && options.orbit == 0 && !options.fov_degrees &&
             !scene.cameras.empty()) {
    views.cameras = {scene.cameras.front()};
  }
  if (!views.cameras.empty()) {
    if (size)
      for (Camera& camera : views.cameras) camera = resized(camera, size->width, size->height);
    return views;
  }

  Lens lens;
  if (size) {
    lens.width = size->width;
    lens.height = size->height;
  }
  if (options.fov_degrees) lens.fov_y = *options.fov_degrees * radians_per_degree;
  const Subject subject = subject_of(scene);
  if (!options.eye.empty()) {
    const glm::dvec3 eye = parse_vector(options.eye);
    const glm::dvec3 target =
        options.target.empty() ? subject.centre() : parse_vector(options.target);
    if (!(glm::length(eye - target) > 0)) throw UsageError("--eye and --target are the same point");
    views.cameras = {look_at(eye, target, subject.up, lens.fov_y, lens.width, lens.height)};
  } else if (options.orbit > 0) {
    views.cameras = orbit(subject, options.orbit, {0.0, orbit_elevation}, lens);
  } else {
    views.cameras = {frame(subject, three_quarter_view, lens)};
  }
  return views;
}

}  // namespace tureen::cli
