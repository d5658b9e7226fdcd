// One training run a set of files: a second one on the same output would write into the log and the
// checkpoint of the first.
#pragma once

#include <filesystem>

namespace tureen::trainer {

class RunLock {
 public:
  /// Holds `file`, which is made where it is not there and goes again with the lock. It is the
  /// system's advisory lock on the open file that counts, not that the file exists: what a run that
  /// was killed leaves behind stops nobody. Where the file system has no locks nothing is held.
  /// Throws UsageError where another run holds it, OutputError where it cannot be made.
  explicit RunLock(std::filesystem::path file);
  RunLock(const RunLock&) = delete;
  RunLock& operator=(const RunLock&) = delete;
  ~RunLock();

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
};

}  // namespace tureen::trainer
