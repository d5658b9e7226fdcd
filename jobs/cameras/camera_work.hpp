// The work folder of a search for cameras: programs run stage by stage, with progress; a stage that
// is done is marked and not repeated.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/platform/file_lock.hpp"

namespace tureen {

struct CameraEvents {
  /// The current work ("matching"), the fraction done of everything, and a forecast of the seconds
  /// left. Called ten times a second; may throw to cancel. The work folder then can be resumed.
  std::function<void(const char* work, double fraction, double seconds_left)> progress;
  std::function<void(const std::string&)> note;  // a sentence
};

/// A call of COLMAP. Stages differ only in these values.
struct ColmapStage {
  std::string name;   // of its marker and its log
  const char* title;  // for people: "matching"
  std::vector<std::string> arguments;
  std::filesystem::path input;  // the file or folder that it needs
  double forecast = 0;          // seconds
  /// The fraction done, 0..1, from a line of its output.
  std::function<std::optional<double>(std::string_view line)> progress = {};
  /// Whether failing is a result, which is marked as well.
  bool may_fail = false;
};

struct CameraWorkOptions {
  std::filesystem::path folder;
  std::string colmap;  // a path, or a name on PATH
  std::string inputs;  // names the photographs
};

class CameraWork {
 public:
  /// Makes the folder, or continues in one with the same inputs; removes the contents of one with
  /// others. Throws UsageError if COLMAP is missing, the folder is no work folder, or another
  /// program uses it; OutputError.
  CameraWork(CameraWorkOptions options, const CameraEvents& events);

  /// A path in the folder.
  std::filesystem::path operator/(const std::filesystem::path& name) const {
    return options_.folder / name;
  }

  /// All work is expected to take this much longer, in seconds.
  void expect(double seconds) { total_ = done_ + seconds; }

  /// Reports short work that has no part in the forecast.
  void show(const char* title) { progress(title, 0, 0); }

  /// Work of this program, unless it is marked as done: calls `work` with its own progress.
  void run(const std::string& name, const char* title, double forecast,
           const std::function<void(const std::function<void(double)>& progress)>& work);
  /// Returns whether it succeeded. Throws Error with the end of its output, unless it may fail.
  bool run(const ColmapStage& stage);

  /// Removes the folder.
  void remove();

 private:
  using Work = std::function<int(const std::function<void(double)>& progress)>;
  int run_once(const std::string& name, const char* title, double forecast, const Work& work);
  void progress(const char* title, double forecast, double fraction);
  int follow(const ColmapStage& stage, const std::filesystem::path& log);

  CameraWorkOptions options_;
  const CameraEvents& events_;
  std::optional<FileLock> lock_;
  double total_ = 0, done_ = 0;      // forecast seconds
  double measured_ = 0, spent_ = 0;  // forecast and real seconds of the work in this process
  double begun_ = 0;                 // the clock when the time in spent_ ended
  /// The last forecast: from it on, the fraction never falls, and the time left counts down until
  /// more is done.
  struct {
    double done = -1, fraction = 0, left = 0, at = 0;
  } told_;
};

}  // namespace tureen
