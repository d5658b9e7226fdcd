// A lock between processes.
#pragma once

#include <filesystem>

namespace tureen {

class FileLock {
 public:
  /// Locks `file` if no other process does; creates it if needed, and removes it with the lock. The
  /// lock is the system's advisory lock on the open file, so a file left by a killed process does
  /// not block the next one. On file systems without locks nothing is locked. Throws OutputError if
  /// the file cannot be created.
  explicit FileLock(std::filesystem::path file);
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;
  ~FileLock();

  /// False if another process has the lock.
  bool is_held() const { return descriptor_ >= 0; }

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
};

}  // namespace tureen
