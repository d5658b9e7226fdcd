// The command line that draws what the window shows, without a window.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scene/camera.hpp"
#include "viewer/debug_view_choice.hpp"
#include "viewer/scene/stage.hpp"

namespace tureen::viewer {

/// The --place options with which reading paths() gives the document: for moved, hidden and shown
/// layers; layers that were removed alone from their file are hidden. Their order in the document
/// is not carried over. Every layer of the document needs an origin.
std::vector<std::string> place_arguments(const SceneSource& scene);

/// "tureen render ..." of all files of the scene, with enough digits to give the same camera.
/// `max_splats`: ReadOptions::max_splats.
/// --eye, --target and --fov cannot describe a shifted principal point or two focal lengths.
/// needs_camera_file() detects these cameras; for them the command reads `camera_file`, which the
/// caller writes. `rays`: with --renderer trace and so many samples, and the materials of changed
/// layers; 0: by OpenGL. Debug views have no rays.
std::string render_command(const SceneSource& scene, const DrawingChoice& choice,
                           const DebugViewChoice& debug_view, const Camera& camera,
                           const std::filesystem::path& camera_file,
                           std::optional<std::uint64_t> max_splats = {}, int rays = 0);

/// The options of `tureen render` and `tureen convert` for the profile and the quality where the
/// choice differs from the files. Without splats, none about splats: the commands refuse them.
/// `resolution_scale`: the command's option for Quality::resolution_scale.
std::vector<std::string> quality_arguments(const SceneSource& scene, const DrawingChoice& choice,
                                           const char* resolution_scale);

bool needs_camera_file(const Camera& camera);

/// A path for a command that is copied: as it is if it lies below the current folder, otherwise
/// absolute, because a terminal may be in another folder.
std::filesystem::path path_for_command(const std::filesystem::path& path);

/// "tureen" and its arguments, for a POSIX shell.
std::string quoted_command(const std::vector<std::string>& arguments);

}  // namespace tureen::viewer
