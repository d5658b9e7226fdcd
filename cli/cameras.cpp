// `tureen cameras`: finds the cameras of photographs, by COLMAP.
#include <memory>

#include "base/error.hpp"
#include "base/existing_path.hpp"
#include "cli/commands.hpp"
#include "cli/files/photograph_cameras.hpp"
#include "cli/report.hpp"
#include "formats/dataset/dataset.hpp"

namespace tureen::cli {

namespace {

struct CamerasCommand {
  CameraOptions job;
  std::string photographs, dataset;
  bool json = false;
  bool resume = false;
};

/// With --resume: throws UsageError if DATASET.work is missing.
void check_resume(const CamerasCommand& command, const std::filesystem::path& dataset) {
  std::error_code ignored;
  const std::filesystem::path work = camera_work_folder(dataset);
  if (command.resume && !std::filesystem::exists(work, ignored))
    throw UsageError("--resume has nothing to continue: " + work.string() + " is missing",
                     "omit --resume to begin; -o must name the dataset of the interrupted search");
}

ExitCode run(const CamerasCommand& command) {
  CameraOptions job = command.job;
  job.photographs = command.photographs;
  require_there(job.photographs);
  Json result;
  if (is_dataset(job.photographs)) {
    if (!command.dataset.empty())
      throw UsageError(command.photographs + " has cameras; its points are written beside them",
                       "omit -o");
    job.dataset = job.photographs;
    check_resume(command, job.dataset);
    const PointOutcome outcome = search_points(job);
    result = {{"photographs", outcome.photographs},
              {"points", outcome.points},
              {"reprojection_error_px", outcome.error_px},
              {"output", outcome.file.string()}};
  } else {
    job.dataset = command.dataset;
    if (job.dataset.empty()) job.dataset = default_dataset(job.photographs);
    check_resume(command, job.dataset);
    const CameraOutcome outcome = search_cameras(job);
    say("Next: tureen train " + job.dataset.string() + " -o scene.glb --method gaussians");
    result = to_json(outcome.quality);
    result["remarks"] = remarks_json(outcome.remarks);
    result["refusals"] = remarks_json(outcome.quality.refusals);
    result["output"] = job.dataset.string();
  }
  if (command.json) print_json_line(result);
  return ExitCode::done;
}

}  // namespace

void add_cameras(Command& program) {
  auto options = std::make_shared<CamerasCommand>();
  Command command = program.add_command("cameras", "Find the cameras of photographs or of a video");
  command.footer(
      R"(Finds the pose and the lens of each photograph with COLMAP 3.8 (no GPU), and writes a dataset for
tureen train: DATASET with the folders images and sparse, and a plot, cameras.svg. From a video, it
takes the sharpest frames (ffmpeg). Prints how many photographs have a camera and how accurate the
cameras are. If they cannot be trusted, stops and prints what to photograph again. After Ctrl-C, the
same command continues.

For a dataset with cameras but without points, keeps the cameras and writes points3D.ply beside
them, where training starts.

Examples:
  tureen cameras photos                        writes photos.dataset
  tureen cameras walk.mp4 -o garden
  tureen cameras lego                          writes lego/points3D.ply
  tureen train photos -o scene.glb             finds the cameras and trains

Exit codes: 0 done, 2 wrong usage, or COLMAP is not installed, 3 the photographs cannot be read or
do not determine the cameras, 5 interrupted, COLMAP failed, or the dataset cannot be written.)");
  command
      .add_option("PHOTOS", options->photographs,
                  "folder of photographs, a video, or a dataset without points")
      .required();
  command.add_option("-o,--output DATASET", options->dataset,
                     "folder to write; by default PHOTOS.dataset");
  add_camera_options(command, options->job);
  command.add_option("--threads N", options->job.threads,
                     "number of CPU threads; one per core by default", between(1, 1024));
  command.add_flag(
      "--resume", options->resume,
      "fail if DATASET.work is missing; without this option, too, a search continues there");
  command.add_flag("--json", options->json,
                   "print the result as one line of JSON to standard output");
  command.does([options] { return run(*options); });
}

}  // namespace tureen::cli
