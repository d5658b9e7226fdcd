// Points for a dataset whose cameras are known and that has none, by COLMAP: where training begins.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "jobs/cameras/camera_run.hpp"
#include "jobs/cameras/photo_neighbors.hpp"
#include "scene/camera.hpp"

namespace tureen {

struct PointOutcome {
  std::size_t photographs = 0, points = 0;
  double error_px = 0;  // mean reprojection error
  std::filesystem::path file;
};

/// The pairs of cameras that see the same, each with at most `most` others. A camera is sampled by
/// points around the place that all cameras look at; a pair overlaps by the share of the points of
/// each that the other has in its image. Directions more than 60 degrees apart are left out, as
/// features do not match over such angles.
PhotoPairs overlapping_pairs(const std::vector<Camera>& cameras, std::size_t most);

/// Writes points3D.ply beside the cameras, where the reader finds it; changes nothing else. The
/// training photographs are used, in the dataset's world, without their distortion. Throws
/// UsageError if the dataset has points, is one of Bundler's, or COLMAP is missing; InputError if
/// no point is found; the errors of read_dataset() and CameraWork.
PointOutcome add_points(const CameraOptions& options, const CameraEvents& events);

}  // namespace tureen
