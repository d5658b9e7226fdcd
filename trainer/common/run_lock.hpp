// One training run per set of files: a second run with the same output would write into the log and
// the checkpoint of the first.
#pragma once

#include <filesystem>

#include "base/platform/file_lock.hpp"

namespace tureen::trainer {

class RunLock {
 public:
  /// Locks `file` (base/platform/file_lock.hpp). Throws UsageError if another run holds the lock,
  /// OutputError if the file cannot be created.
  explicit RunLock(const std::filesystem::path& file);

 private:
  FileLock lock_;
};

}  // namespace tureen::trainer
