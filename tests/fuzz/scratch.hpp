// Shared by targets: a check for scenes, and folders for formats that are folders.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "scene/scene.hpp"
#include "tests/fuzz/targets.hpp"

namespace tureen::fuzz {

/// Aborts the program if the scene has a defect: readers must return scenes without defects.
void require_whole(const Scene& scene);

/// A new, empty folder of this process. The destructor removes it.
class Scratch {
 public:
  explicit Scratch(const std::string& name);
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  ~Scratch();

  const std::filesystem::path& folder() const { return folder_; }
  void write(const std::string& name, Bytes bytes) const;
  void write(const std::string& name, std::string_view text) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace tureen::fuzz
