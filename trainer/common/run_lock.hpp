// One training run per set of files: a second run with the same output would write into the log and
// the checkpoint of the first.
#pragma once

#include <filesystem>

namespace tureen::trainer {

class RunLock {
 public:
  /// Locks `file`; creates it if needed, and removes it with the lock. The lock is the system's
  /// advisory lock on the open file, so a file left by a killed run does not block the next run.
  /// On file systems without locks nothing is locked.
  /// Throws UsageError if another run holds the lock, OutputError if the file cannot be created.
  explicit RunLock(std::filesystem::path file);
  RunLock(const RunLock&) = delete;
  RunLock& operator=(const RunLock&) = delete;
  ~RunLock();

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
};

}  // namespace tureen::trainer
