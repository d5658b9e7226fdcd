// The path of a temporary file or folder. The destructor removes it.
#pragma once

#include <filesystem>

namespace tureen::cli {

class Scratch {
 public:
  /// Does not create the file. Throws UsageError if `path` exists already. `purpose`: its
  /// description in the error, such as "the export for the comparison".
  Scratch(std::filesystem::path path, const char* purpose);
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  ~Scratch();

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace tureen::cli
