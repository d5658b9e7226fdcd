// Detects changes of a file, or of the files in a folder, by polling. Network folders do not send
// the system's notifications.
#pragma once

#include <cstdint>
#include <filesystem>

namespace tureen::viewer {

class FileWatch {
 public:
  FileWatch() = default;
  explicit FileWatch(std::filesystem::path path);

  /// True once for each change, as soon as two successive calls find the same state. A file that is
  /// being written is thus not read too early. False while it is missing.
  bool changed();

 private:
  /// Hash of names, times and sizes of all files; 0 without files.
  std::uint64_t fingerprint() const;

  std::filesystem::path path_;
  std::uint64_t known_ = 0, last_ = 0;
};

}  // namespace tureen::viewer
