// The options that select views, and the cameras that they select.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/options/arguments.hpp"
#include "scene/scene.hpp"

namespace tureen::cli {

/// As typed; empty or 0 if not given.
struct ViewOptions {
  std::string size;                   // "1280x720"
  std::string camera;                 // "FILE", "FILE:3" or "FILE:all"
  std::string eye;                    // "x,y,z" in world coordinates
  std::string target;                 // "x,y,z"
  std::optional<double> fov_degrees;  // full vertical angle
  int orbit = 0;                      // number of views
  std::string path;                   // file (docs/camera-paths.md), or "cameras:SECONDS"
  double turntable = 0;               // seconds per turn
  std::optional<double> frames_per_second;

  bool is_animation() const { return !path.empty() || turntable > 0; }
  /// Whether the view is the first one of the scene.
  bool is_first_view() const {
    return camera.empty() && eye.empty() && orbit == 0 && !is_animation() && !fov_degrees;
  }
  /// Whether the cameras depend on the scene's up axis.
  bool depends_on_up(const Scene& scene) const {
    return camera.empty() && path.empty() && !(is_first_view() && scene.first_view);
  }
};

/// --size, --camera, --eye, --target, --fov, --orbit, --path, --turntable and --fps, with their
/// help and exclusions. --up belongs to the scene (cli/options/scene_argument.hpp).
void add_view_options(Command& command, ViewOptions& options);

struct Views {
  std::vector<Camera> cameras;     // at least one
  std::vector<std::string> notes;  // on missing data in a camera file
  double frames_per_second = 0;    // above 0: the cameras are the frames of an animation
};

/// Checks the options before anything is read. Throws UsageError.
void check(const ViewOptions& options);

/// The cameras, in this order of preference: --camera; the frames of --path or --turntable; --eye;
/// --orbit; first_view_of() the scene (camera/capture.hpp); a three-quarter view of the whole
/// scene. Without --size, a recorded camera keeps its size, the frames of a path have the size of
/// its first camera, and all other views have 1280x720. `scene_path`: path of the scene; for
/// --camera with this path, returns the scene's cameras. Throws UsageError and InputError.
Views resolve_views(const ViewOptions& options, const Scene& scene, const std::string& scene_path);

/// The cameras that "FILE", "FILE:3" or "FILE:all" names. `which_without`: the part after the colon
/// if there is none. Throws InputError and UsageError.
Views recorded_views(const std::string& argument, const std::string& which_without,
                     const Scene& scene, const std::string& scene_path);

}  // namespace tureen::cli
