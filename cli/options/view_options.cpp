#include "cli/options/view_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <glm/geometric.hpp>

#include "base/error.hpp"
#include "base/existing_path.hpp"
#include "camera/camera_path.hpp"
#include "camera/capture.hpp"
#include "camera/recorded_path.hpp"
#include "cli/options/values.hpp"
#include "cli/report.hpp"
#include "formats/dataset/camera_file.hpp"
#include "formats/scene_file.hpp"

namespace tureen::cli {

namespace {

namespace fs = std::filesystem;

constexpr double radians_per_degree = 0.017453292519943295;
constexpr int max_orbit_views = 1000;
constexpr double default_frames_per_second = 30;
constexpr double max_frames = 100000;  // 56 min at 30 frames/s; more is probably a wrong unit

/// Splits "FILE:N", where N is a number or "all". If a file with the whole text as its name exists,
/// the text is not split.
struct CameraArgument {
  fs::path file;
  std::string which;

  CameraArgument(const std::string& text, std::string which_without)
      : file(text), which(std::move(which_without)) {
    const std::size_t colon = text.rfind(':');
    if (!is_missing(file) || colon == std::string::npos) return;
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
  require_there(file);
  std::error_code error;
  if (fs::equivalent(file, scene_path, error)) return {scene.cameras, {}};
  if (is_camera_file(file)) return read_cameras(file);
  return {read_scene(file).cameras, {}};
}

/// The frames of an animation. Throws UsageError if there are too many.
Views animation(CameraPathData data, const FrameRate& rate) {
  const CameraPath path(std::move(data));
  const double count = frame_count(path, rate.frames_per_second);
  if (count > max_frames)
    throw UsageError(
        fmt::format("{:.0f} seconds at {} frames per second are {:.0f} frames; the limit is {:.0f}",
                    path.duration(), rate.frames_per_second, count, max_frames));
  return {frames(path, rate), {}, rate.frames_per_second};
}

/// "cameras" or "cameras:SECONDS"; nullopt for the name of a file.
struct AlongCameras {
  std::optional<double> seconds;
};
std::optional<AlongCameras> along_cameras(const std::string& text) {
  constexpr std::string_view word = "cameras";
  if (text == word) return AlongCameras{};
  if (!text.starts_with(word) || text[word.size()] != ':') return std::nullopt;
  const std::optional<double> seconds = number_from(text.substr(word.size() + 1));
  if (!seconds || !(*seconds >= 0.001 && *seconds <= 36000))
    throw UsageError("--path " + text + " needs seconds from 0.001 to 36000");
  return AlongCameras{*seconds};
}

CameraPathData path_named(const std::string& text, const Scene& scene) {
  if (const auto along = along_cameras(text)) {
    if (scene.cameras.empty())
      throw UsageError("--path cameras needs recorded cameras; the scene has none",
                       "--turntable SECONDS needs none; ./cameras is a file of this name");
    CameraPathData path = path_along(scene.cameras, along->seconds);
    if (path.keyframes.empty())
      throw InputError({}, "no recorded camera of the scene can be used for a path");
    return path;
  }
  require_there(text);
  if (is_scene(text))
    throw InputError({text}, "a scene, not a camera path, which is a JSON file",
                     "--path cameras flies along the recorded cameras of the scene that is drawn");
  return read_path(text);
}

Views animation_along(CameraPathData path, FrameRate rate, const std::optional<ImageSize>& size) {
  const Camera& first = path.keyframes.front().camera;
  rate.width = size ? size->width : first.width;
  rate.height = size ? size->height : first.height;
  return animation(std::move(path), rate);
}

}  // namespace

Views recorded_views(const std::string& argument, const std::string& which_without,
                     const Scene& scene, const std::string& scene_path) {
  CameraArgument wanted(argument, which_without);
  if (argument.find_first_not_of("0123456789") == argument.npos && is_missing(wanted.file))
    wanted = CameraArgument(scene_path, argument);
  CameraFile found = cameras_in(wanted.file, scene, scene_path);
  if (found.cameras.empty()) throw InputError({wanted.file.string()}, "the file has no cameras");
  if (wanted.which == "all") return {std::move(found.cameras), notes_of(found.remarks)};
  const int last = int(found.cameras.size()) - 1;
  // Tests the length first, because std::stol throws for a number of forty digits.
  if (wanted.which.size() > 9 || std::stol(wanted.which) > last)
    throw UsageError(argument + ": cameras are numbered from 0 to " + std::to_string(last));
  return {{found.cameras[std::size_t(std::stol(wanted.which))]}, notes_of(found.remarks)};
}

namespace {

void add_animation_options(Command& command, ViewOptions& options) {
  Option path = command.add_option(
      "--path FILE.json|cameras[:SECONDS]", options.path,
      "draw frames along a camera path: a JSON file with \"cameras\" and their \"seconds\" "
      "(docs/camera-paths.md), or a smooth flight along the scene's recorded cameras");
  for (const char* other : {"--camera", "--eye", "--fov", "--orbit"})
    path.excludes(command.option(other));
  Option turntable =
      command.add_option("--turntable SECONDS", options.turntable,
                         "draw the frames of one turn around the up axis; the camera moves as for "
                         "--orbit, or starts at --eye and circles --target",
                         between(0.001, 36000.0));
  for (const Option& other : {command.option("--camera"), command.option("--orbit"), path})
    turntable.excludes(other);
  command.add_option("--fps N", options.frames_per_second,
                     "frames per second for --path and --turntable, 30 by default",
                     between(0.01, 1000.0));
}

}  // namespace

void check(const ViewOptions& options) {
  if (!options.size.empty()) parse_any_size(options.size);
  along_cameras(options.path);
  if (options.frames_per_second && !options.is_animation())
    throw UsageError("--fps needs --path or --turntable");
}

void add_view_options(Command& command, ViewOptions& options) {
  command.add_option("--size WxH", options.size,
                     "width and height in pixels, 1280x720 by default; recorded cameras keep their "
                     "own size by default");
  const Option camera = command.add_option(
      "--camera FILE[:N|:all]|N", options.camera,
      "camera N of FILE, counted from 0, or all its cameras; a number alone: of SCENE. FILE is a "
      "JSON file written by "
      "Tureen, NeRF's transforms.json, cameras.json from 3D Gaussian Splatting, the folder of a "
      "COLMAP model, or a scene with cameras, such as SCENE");
  const Option eye =
      command
          .add_option("--eye X,Y,Z", options.eye,
                      "eye position in world coordinates; the camera looks at --target")
          .excludes(camera);
  command
      .add_option(
          "--target X,Y,Z", options.target,
          "point in the centre of the image, in world coordinates; by default the point that "
          "the recorded cameras look at, or the centre of the scene")
      .needs(eye);
  command
      .add_option("--fov DEGREES", options.fov_degrees,
                  "full vertical field of view in degrees; by default 40, or that of the recorded "
                  "cameras for views around the point that they look at",
                  between(0.1, 179.0))
      .excludes(camera);
  command
      .add_option("--orbit N", options.orbit,
                  "draw N views in a circle around the up axis: around the point that the recorded "
                  "cameras look at, at their distance and height. Without cameras, or if they "
                  "surround an object, each view shows the whole scene, slightly from above",
                  between(1, max_orbit_views))
      .excludes(camera)
      .excludes(eye);
  add_animation_options(command, options);
}

Views resolve_views(const ViewOptions& options, const Scene& scene, const std::string& scene_path) {
  std::optional<ImageSize> size;
  if (!options.size.empty()) size = parse_any_size(options.size);

  FrameRate rate;
  rate.frames_per_second = options.frames_per_second.value_or(default_frames_per_second);
  if (!options.path.empty()) return animation_along(path_named(options.path, scene), rate, size);

  Views views;
  if (!options.camera.empty()) {
    views = recorded_views(options.camera, "0", scene, scene_path);
  } else if (options.is_first_view()) {
    if (const auto first =
            first_view_of(scene.first_view, scene.cameras, glm::dvec3(scene.info.up)))
      views.cameras = {*first};
  }
  if (!views.cameras.empty()) {
    if (size)
      for (Camera& camera : views.cameras) {
        if (options.is_first_view()) camera = whole_in({size->width, size->height}, camera);
        camera = resized(camera, size->width, size->height);
      }
    return views;
  }

  const std::vector<LayerPlace> boxes = boxes_of(scene);
  const glm::dvec3 up(scene.info.up);
  const Subject subject = subject_of(boxes, up, scene.cameras);
  const std::optional<Capture> capture = capture_of(scene.cameras, up, boxes);
  Lens lens;
  if (size) {
    lens.width = size->width;
    lens.height = size->height;
  }
  if (capture && options.eye.empty()) lens = lens_of(*capture, lens.width, lens.height);
  rate.width = lens.width;
  rate.height = lens.height;
  if (options.fov_degrees) lens.fov_y = *options.fov_degrees * radians_per_degree;
  if (!options.eye.empty()) {
    const glm::dvec3 eye = parse_vector(options.eye);
    const glm::dvec3 target = !options.target.empty() ? parse_vector(options.target)
                              : capture               ? capture->center
                                                      : subject.center();
    if (!(glm::length(eye - target) > 0)) throw UsageError("--eye and --target are the same point");
    views.cameras = {look_at(eye, target, subject.up, lens.fov_y, lens.width, lens.height)};
    if (options.turntable > 0)
      return animation(turntable({.first = views.cameras.front(),
                                  .distance = glm::length(eye - target),
                                  .up = subject.up,
                                  .seconds = options.turntable}),
                       rate);
  } else if (options.turntable > 0 && capture) {
    return animation(turntable(*capture, lens, options.turntable), rate);
  } else if (options.turntable > 0) {
    return animation(turntable(subject, {0.0, orbit_elevation}, lens, options.turntable), rate);
  } else if (options.orbit > 0) {
    views.cameras = capture ? orbit(*capture, options.orbit, lens)
                            : orbit(subject, options.orbit, {0.0, orbit_elevation}, lens);
  } else if (capture) {
    views.cameras = {view_of(*capture, 0, lens)};
  } else {
    views.cameras = {frame(subject, three_quarter_view, lens)};
  }
  return views;
}

}  // namespace tureen::cli
