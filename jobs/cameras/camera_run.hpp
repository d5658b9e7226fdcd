// Cameras for photographs, by COLMAP: from a folder of images or a video to a dataset in COLMAP's
// layout, which trains. A search that was interrupted continues where it stopped.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "jobs/cameras/camera_quality.hpp"
#include "jobs/cameras/camera_work.hpp"

namespace tureen {

struct CameraOptions {
  std::filesystem::path photographs;  // a folder, or a video; nothing for add_points()
  std::filesystem::path dataset;      // to write; for add_points(), as read_dataset() takes it
  std::string colmap = "colmap";      // a path, or a name on PATH
  int threads = 0;                    // 0: one per core
  bool keep_work = false;             // keep the work folder after success
  bool accept = false;                // write the dataset in spite of refusals, if there is a model
};

struct CameraOutcome {
  CameraQuality quality = {};
  std::vector<Remark> remarks = {};  // about photographs that were left out
  /// Whether the dataset was written: there is no refusal, or it was accepted. If not, the work
  /// folder stays, unless there are too few photographs.
  bool is_written = false;
};

int threads_of(const CameraOptions& options);

/// The folder of the unfinished work for a dataset: DATASET.work.
std::filesystem::path camera_work_folder(const std::filesystem::path& dataset);

/// Whether `path` is a video or a folder with images, and no dataset. Opens no file.
bool is_photographs(const std::filesystem::path& path);

/// Whether `options.dataset` is a finished dataset from these photographs.
bool has_cameras(const CameraOptions& options);

/// Writes the dataset: the folder images with links to the photographs, or copies on another file
/// system, and sparse/0, a COLMAP model. Its world is COLMAP's. Throws UsageError, InputError,
/// OutputError and Error (a program failed) with the reason and a way out.
CameraOutcome find_cameras(const CameraOptions& options, const CameraEvents& events);

}  // namespace tureen
