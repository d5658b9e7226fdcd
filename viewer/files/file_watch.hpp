// Whether a file, or what lies in a folder, has changed since it was read. Asked now and then: no
// notifications of the system's, which network folders do not send.
#pragma once

#include <cstdint>
#include <filesystem>

namespace tureen::viewer {

class FileWatch {
 public:
  FileWatch() = default;
  explicit FileWatch(std::filesystem::path path);

  /// Whether it changed and has been at rest since the last question, so that a file that is being
  /// written is not read too early. Once for each change. False while it is missing.
  bool changed();

 private:
  /// Of all files together; 0 where there are none.
  std::uint64_t fingerprint() const;

  std::filesystem::path path_;
  std::uint64_t known_ = 0, last_ = 0;
};

}  // namespace tureen::viewer
