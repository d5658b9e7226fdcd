// What targets share: scenes that readers promise to be whole, and folders for formats that are
// folders.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "scene/scene.hpp"
#include "tests/fuzz/targets.hpp"

namespace tureen::fuzz {

/// Ends the program where a reader broke its word: the scene has a defect.
void require_whole(const Scene& scene);

/// A folder of this process, empty at first, removed at its end.
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
