// Which views to draw: the options of the command line, and the cameras that they ask for.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/options/arguments.hpp"
#include "scene/scene.hpp"

namespace tureen::cli {

/// As typed; empty and 0 stand for what was not given.
struct ViewOptions {
  std::string size;                   // "1280x720"
  std::string camera;                 // "FILE", "FILE:3" or "FILE:all"
  std::string eye;                    // "x,y,z" in world coordinates
  std::string target;                 // "x,y,z"
  std::optional<double> fov_degrees;  // full vertical angle
  int orbit = 0;                      // number of views
  std::string path;                   // a camera path of ours
  double turntable = 0;               // seconds of a turn
  std::optional<double> frames_per_second;

  bool is_animation() const { return !path.empty() || turntable > 0; }
};

/// --size, --camera, --eye, --target, --fov, --orbit, --path, --turntable and --fps, with their
/// help and exclusions. --up belongs to the scene (cli/options/scene_argument.hpp).
void add_view_options(Command& command, ViewOptions& options);

struct Views {
  std::vector<Camera> cameras;     // at least one
  std::vector<std::string> notes;  // on what a camera file lacked
  double frames_per_second = 0;    // above 0: the cameras are the frames of an animation
};

/// What can be wrong with them before anything is read. Throws UsageError.
void check(const ViewOptions& options);

/// The cameras, in this order of preference: those of --camera; the frames of --path or
/// --turntable;
/// --eye; --orbit; the scene's first; a three-quarter view that frames the scene. Without --size a
/// camera keeps its own size, frames of a path have that of its first camera, and a view of ours
/// has 1280x720. `scene_path` is the scene's own, which --camera may name to take its cameras.
/// Throws UsageError and InputError.
Views resolve_views(const ViewOptions& options, const Scene& scene, const std::string& scene_path);

/// The cameras that "FILE", "FILE:3" or "FILE:all" names; `which_without` stands for what follows
/// the colon where nothing does. Throws InputError and UsageError.
Views recorded_views(const std::string& argument, const std::string& which_without,
                     const Scene& scene, const std::string& scene_path);

}  // namespace tureen::cli
