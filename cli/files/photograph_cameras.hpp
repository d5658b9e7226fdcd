// Photographs without cameras on the command line: the search for their cameras with progress, its
// result in words, and its plot.
#pragma once

#include "cli/options/arguments.hpp"
#include "jobs/cameras/known_cameras.hpp"

namespace tureen::cli {

/// Adds --colmap, --accept and --keep-work. `options` must live until the arguments are parsed.
void add_camera_options(Command& command, CameraOptions& options);

/// NAME.dataset in the current folder, for photographs in the folder NAME or the video NAME.mp4.
std::filesystem::path default_dataset(const std::filesystem::path& photographs);

/// moderate_scale() of a dataset's photographs. Throws the errors of read_dataset_summary().
double scale_for_training(const std::filesystem::path& dataset);

/// Finds the cameras, prints how good they are, and writes the dataset with its plot, cameras.svg.
/// Throws InputError with the reasons if the cameras are refused, and the errors of find_cameras().
CameraOutcome search_cameras(const CameraOptions& options);

/// Adds points to a dataset that has cameras, and prints how good they are. Throws the errors of
/// add_points().
PointOutcome search_points(const CameraOptions& options);

}  // namespace tureen::cli
