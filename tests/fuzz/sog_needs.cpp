// The files that a streamed SOG needs, whose images a page has not fetched yet. The first byte
// selects the file that has the other bytes, the second the level.
#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "formats/sog/sog.hpp"
#include "tests/fuzz/folder_files.hpp"
#include "tests/fuzz/scratch.hpp"

namespace tureen::fuzz {

namespace {

FolderFiles json_files() {
  FolderFiles files = sog_files();
  std::erase_if(files, [](const auto& file) { return !file.first.ends_with(".json"); });
  return files;
}

}  // namespace

void sog_needs(Bytes bytes) {
  if (bytes.size() < 2) return;
  static ScratchFiles files("sog_needs", json_files());
  files.replace(std::to_integer<std::size_t>(bytes[0]), bytes.subspan(2));
  const SogNeeds needs =
      tureen::sog_needs(files.folder(), {.lod = std::to_integer<std::size_t>(bytes[1])});
  if (!needs.levels.empty() && needs.level >= needs.levels.size()) std::abort();
  // A page appends them to an address.
  for (const std::string& name : needs.missing)
    if (name.empty() || name[0] == '/' || std::ranges::count(std::filesystem::path(name), "..") > 0)
      std::abort();
}

}  // namespace tureen::fuzz
