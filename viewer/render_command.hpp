// The command line that draws what the window shows, without a window.
#pragma once

#include <filesystem>
#include <string>

#include "scene/camera.hpp"
#include "viewer/debug_view_choice.hpp"
#include "viewer/stage.hpp"

namespace tureen::viewer {

/// "tureen render ..." with as many digits as it takes to name the same camera. A camera that
/// --eye,
/// --target and --fov cannot say (a shifted principal point, two focal lengths) is asked for from
/// `camera_file`, which the caller writes; what is needed is told by needs_camera_file().
std::string render_command(const StageSource& scene, const DrawingChoice& choice,
                           const DebugViewChoice& debug_view, const Camera& camera,
                           const std::filesystem::path& camera_file);

bool needs_camera_file(const Camera& camera);

/// For a POSIX shell: as it is where it is plain, in single quotes otherwise.
std::string quoted(const std::string& text);

}  // namespace tureen::viewer
