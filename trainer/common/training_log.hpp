// The log of a training run: JSON lines, one object a line, appended and flushed as the run goes,
// so that it can be watched and is whole up to its last line whatever ends the run.
//
//   {"step":200,"seconds":14.2,"loss":0.081,"l1":0.052,"ssim":0.79,"train_psnr_db":21.3,
//    "test_psnr_db":20.8,"triangles":15000,"it_per_second":14.1,"non_finite":0}      in one line
#pragma once

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tureen::trainer {

/// What a line holds. NaN, which a run that goes wrong has, is null in JSON.
struct TrainingRecord {
  int step = 0;        // steps done; grows from line to line
  double seconds = 0;  // of training, all sessions of a resumed run together
  double loss = 0;
  double l1 = 0;                            // the loss's two parts, unweighted
  double ssim = 0;                          // 1 for equal images
  double train_psnr_db = 0;                 // of the step's views
  std::optional<double> test_psnr_db = {};  // of held-out views, where it was measured
  std::size_t triangles = 0;
  double it_per_second = 0;    // since the line before
  std::size_t non_finite = 0;  // numbers put aside so far because they were none
};

class TrainingLog {
 public:
  /// An empty log, in place of any that is there. Throws OutputError.
  static TrainingLog create(const std::filesystem::path& path);

  /// The log of a run that goes on after `step`: what is there beyond that step, or cut short in
  /// its last line, is taken off. Where there is no log, an empty one. Throws InputError for a file
  /// that is no log, and OutputError.
  static TrainingLog resume(const std::filesystem::path& path, int step);

  /// A line, flushed. Throws OutputError.
  void append(const TrainingRecord& record);

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  TrainingLog(const std::filesystem::path& path, const char* mode);

  std::string name_;
  std::unique_ptr<std::FILE, Close> file_;
};

/// The records of a log. A last line without its end, which a run may be writing, is left out.
/// Throws InputError with the line that is no record, or that does not come after the one before.
std::vector<TrainingRecord> read_training_log(const std::filesystem::path& path);

}  // namespace tureen::trainer
