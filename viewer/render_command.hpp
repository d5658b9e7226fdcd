// The command line that draws what the window shows, without a window.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scene/camera.hpp"
#include "viewer/debug_view_choice.hpp"
#include "viewer/scene/stage.hpp"

namespace tureen::viewer {

/// "tureen render ..." of all files of the scene, with enough digits to give the same camera.
/// --eye, --target and --fov cannot describe a shifted principal point or two focal lengths.
/// needs_camera_file() detects these cameras; for them the command reads `camera_file`, which the
/// caller writes.
std::string render_command(const SceneSource& scene, const DrawingChoice& choice,
                           const DebugViewChoice& debug_view, const Camera& camera,
                           const std::filesystem::path& camera_file);

/// The options of `tureen render` and `tureen convert` for the profile and the quality where the
/// choice differs from the files. Without splats, none about splats: the commands refuse them.
/// `resolution_scale`: the command's option for Quality::resolution_scale.
std::vector<std::string> quality_arguments(const SceneSource& scene, const DrawingChoice& choice,
                                           const char* resolution_scale);

bool needs_camera_file(const Camera& camera);

/// The text for a POSIX shell: unchanged if it has only plain characters, otherwise in single
/// quotes.
std::string quoted(const std::string& text);

/// "tureen" and its arguments, for a POSIX shell.
std::string quoted_command(const std::vector<std::string>& arguments);

}  // namespace tureen::viewer
