// Valid files of the formats that are folders.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "tests/fuzz/scratch.hpp"

namespace tureen::fuzz {

/// Names and contents.
using FolderFiles = std::vector<std::pair<std::string, std::vector<std::byte>>>;

FolderFiles diffsoup_files();
FolderFiles mobilenerf_files();
/// A streamed SOG.
FolderFiles sog_files();

/// A folder with all these files, except one with other content.
class ScratchFiles {
 public:
  ScratchFiles(const std::string& name, FolderFiles valid);

  const std::filesystem::path& folder() const { return scratch_.folder(); }
  /// Gives file `index`, modulo the number of files, the content `bytes`, and restores the previous
  /// one.
  void replace(std::size_t index, Bytes bytes);

 private:
  Scratch scratch_;
  FolderFiles valid_;
  std::size_t replaced_ = 0;
};

}  // namespace tureen::fuzz
