// The log of a training run: JSON lines, one object per line. The run appends and flushes each
// line, so the log can be followed, and it is complete up to its last line however the run ends.
//
//   {"step":0,"plan":{...}}                     what the run will do (jobs/training/run_plan.hpp)
//   {"step":200,"steps":10000,"seconds":14.2,"seconds_left":690.1,"loss":0.081,"l1":0.052,"ssim":0.79,"train_psnr_db":21.3,
//    "test_psnr_db":20.8,"triangles":15000,"it_per_second":14.1,"non_finite":0}      in one line
//
// The first line may be missing. Runs of splats have "splats" instead of "triangles". If RunControl
// ended the run before its last step, the last line also has "ended_early":true.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "trainer/common/primitive_count.hpp"

namespace tureen::trainer {

/// One line. NaN (from a run that diverges) is null in JSON.
struct TrainingRecord {
  int step = 0;                             // steps done; grows from line to line
  std::optional<int> steps = {};            // of the whole run; older logs lack it
  double seconds = 0;                       // training time over all sessions of a resumed run
  std::optional<double> seconds_left = {};  // a forecast; older logs lack it
  double loss = 0;
  double l1 = 0;                            // the loss's two parts, unweighted
  double ssim = 0;                          // 1 for equal images
  double train_psnr_db = 0;                 // of the step's views
  std::optional<double> test_psnr_db = {};  // of held-out views, if measured
  PrimitiveCount primitives = {PrimitiveKind::triangles, 0};
  double it_per_second = 0;    // since the previous line
  std::size_t non_finite = 0;  // numbers quarantined so far because they were not finite
  bool ended_early = false;    // by RunControl; only in the last record
};

class TrainingLog {
 public:
  /// An empty log; replaces an existing file. Throws OutputError.
  static TrainingLog create(const std::filesystem::path& path);

  /// The log of a run that resumes after `step`. Removes the lines after that step and an
  /// incomplete last line; creates an empty log if there is none. Throws InputError if the file is
  /// not a log, and OutputError.
  static TrainingLog resume(const std::filesystem::path& path, int step);

  /// The first line: `plan` is a JSON object. Flushes it, as append() does. Throws OutputError.
  void append_plan(const std::string& plan);
  /// Appends a line and flushes it. Throws OutputError.
  void append(const TrainingRecord& record);

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  TrainingLog(const std::filesystem::path& path, const char* mode);
  void append_line(std::string line);

  std::string name_;
  std::unique_ptr<std::FILE, Close> file_;
};

/// A log as far as it is read.
struct ReadTrainingLog {
  std::vector<std::string> plan;  // for people, as lines; empty without a first line about it
  std::vector<TrainingRecord> records;
  std::uint64_t begin = 0;          // byte after the line of the plan
  std::vector<std::uint64_t> ends;  // byte after each record's line
};

/// The records of a log. Skips a last line without a line end, which a run may be writing. Throws
/// InputError with the number of a line that is not a record, or whose step is not larger than the
/// previous one.
std::vector<TrainingRecord> read_training_log(const std::filesystem::path& path);

/// A log that a run is writing. Each update reads only what was appended.
class TrainingLogTail {
 public:
  explicit TrainingLogTail(std::filesystem::path path) : path_(std::move(path)) {}

  /// Reads the new complete lines. Begins again if another run replaced the log, and has no records
  /// while the file is missing. Returns whether the file has changed. Throws the errors of
  /// read_training_log; the records before the wrong line remain.
  bool update();
  const std::vector<TrainingRecord>& records() const { return log_.records; }
  const std::vector<std::string>& plan() const { return log_.plan; }

 private:
  std::filesystem::path path_;
  ReadTrainingLog log_;
  std::uint64_t size_ = 0;  // of the file at the last update
};

}  // namespace tureen::trainer
