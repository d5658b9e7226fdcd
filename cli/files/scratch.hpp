// A file or folder that is made for a moment and gone when this is, whatever happens meanwhile.
#pragma once

#include <filesystem>

namespace tureen::cli {

class Scratch {
 public:
  /// Makes nothing yet. Throws UsageError where something lies at `path` already; `purpose` is told
  /// then, as in "the export to compare with".
  Scratch(std::filesystem::path path, const char* purpose);
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  ~Scratch();

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace tureen::cli
