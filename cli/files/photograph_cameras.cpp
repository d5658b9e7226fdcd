#include "cli/files/photograph_cameras.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "base/decimal_text.hpp"
#include "base/error.hpp"
#include "base/output.hpp"
#include "cli/files/camera_plot.hpp"
#include "cli/interrupt.hpp"
#include "cli/progress.hpp"
#include "cli/report.hpp"
#include "jobs/training/photograph_size.hpp"

namespace tureen::cli {

namespace {

/// Events that show a bar and print notes above it.
class Reported {
 public:
  explicit Reported(const char* task) {
    Progress::Output output = Progress::standard_error();
    output.line_seconds = 10;
    events.progress = [this, task, output](const char* work, double fraction, double left) {
      if (!progress_) progress_.emplace(task, output);
      progress_->update(
          fraction,
          left > 0 ? fmt::format("{}, about {} left", work, duration_text(std::ceil(left))) : work);
    };
    events.note = [this](const std::string& sentence) {
      clear();
      say(sentence);
    };
  }
  void clear() { progress_.reset(); }

  CameraEvents events;

 private:
  std::optional<Progress> progress_;
};

/// Throws InputError with what was found and what to photograph again.
void refuse(const CameraOptions& options, const CameraQuality& quality) {
  std::string reasons;
  for (const Remark& remark : quality.refusals)
    reasons += (reasons.empty() ? "" : " ") + describe(remark);
  if (reasons.empty()) reasons = "COLMAP placed no camera.";
  reasons.pop_back();
  const bool is_untried = quality.models.empty() && quality.photographs < least_photographs;
  const bool may_go_on =
      !options.accept && (quality.registered > 0 || (is_untried && quality.photographs >= 3));
  throw InputError({options.photographs.string()}, "no cameras that can be trusted: " + reasons,
                   may_go_on ? "the same command with --accept goes on all the same" : "");
}

}  // namespace

void add_camera_options(Command& command, CameraOptions& options) {
  const char* group = "Options for photographs without cameras";
  command
      .add_option("--colmap PROGRAM", options.colmap,
                  "COLMAP program that finds the cameras; by default colmap on PATH")
      .group(group);
  command
      .add_flag("--accept", options.accept,
                "continue with cameras that would be rejected: too few were found, or too little "
                "was measured")
      .group(group);
  command
      .add_flag("--keep-work", options.keep_work,
                "keep the folder with COLMAP's database, models and logs, DATASET.work")
      .group(group);
}

std::filesystem::path default_dataset(const std::filesystem::path& photographs) {
  const auto path = photographs.has_filename() ? photographs : photographs.parent_path();
  std::error_code ignored;
  const auto name = std::filesystem::is_directory(path, ignored) ? path.filename() : path.stem();
  return name.empty() || name == "." || name == ".." ? "photographs.dataset"
                                                     : name.string() + ".dataset";
}

double scale_for_training(const std::filesystem::path& dataset) {
  const DatasetSummary summary = read_dataset_summary(dataset);
  std::vector<Camera> cameras;
  for (const auto* views : {&summary.train, &summary.test})
    for (const DatasetSummary::View& view : *views) cameras.push_back(view.camera);
  return moderate_scale(cameras);
}

CameraOutcome search_cameras(const CameraOptions& options) {
  Reported reported("cameras");
  CameraOutcome outcome = [&] {
    try {
      return find_cameras(options, reported.events);
    } catch (const Interrupted&) {
      say("the same command continues the search");
      throw;
    }
  }();
  reported.clear();
  if (outcome.quality.registered > 0)
    say_list("Cameras of " + options.photographs.string() + ":", describe(outcome.quality));
  for (const Remark& remark : outcome.quality.notes) say(describe(remark));
  if (!outcome.is_written) refuse(options, outcome.quality);
  say_list("Accepted in spite of this:", described(outcome.quality.refusals));
  write_file(options.dataset / "cameras.svg", camera_plot(read_dataset_summary(options.dataset)));
  say("wrote " + options.dataset.string() + ", with a plot of the cameras in cameras.svg");
  return outcome;
}

PointOutcome search_points(const CameraOptions& options) {
  Reported reported("points");
  PointOutcome outcome = add_points(options, reported.events);
  reported.clear();
  say(fmt::format("wrote {}: {} from {}, reprojection error {:.2f} px", outcome.file.string(),
                  counted(outcome.points, "point"), counted(outcome.photographs, "photograph"),
                  outcome.error_px));
  return outcome;
}

}  // namespace tureen::cli
