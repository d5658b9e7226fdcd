// Finds the files that a dataset names, also where the name differs from the file's: in case, in
// its suffix, in separators, in the form of its Unicode letters, or in its leading folders, as
// after a copy between systems.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

namespace tureen {

/// The suffixes of photographs and masks.
extern const std::span<const char* const> image_suffixes;

class NearFiles {
 public:
  struct Found {
    std::filesystem::path path;
    bool is_exact = true;
  };

  /// The file `name`, relative to `folder`, or absolute if it exists. ".." and links may lead out
  /// of the folder. An image's name may lack its suffix. Otherwise the only file below `folder`
  /// whose name is near: letters are compared without case and in one Unicode form, "\" is "/",
  /// another of `suffixes` may stand in its place, and one of both paths may have further leading
  /// folders. A folder of masks is searched only for a name with such a folder. nullopt if no file
  /// or several fit.
  std::optional<Found> find(const std::filesystem::path& folder, const std::string& name,
                            std::span<const char* const> suffixes = image_suffixes);

  /// The file below `folder` whose name is the most similar to that of `name`, for a message; empty
  /// if the folder has none.
  std::string nearest(const std::filesystem::path& folder, const std::string& name);

 private:
  struct File {
    std::filesystem::path path;
    std::vector<std::string> parts;  // folded, from the folder on; the last without its suffix
    std::string suffix;              // folded
  };
  struct Folder {
    std::vector<File> files;
    std::unordered_multimap<std::string, std::size_t> by_stem;
  };
  const Folder& listed(const std::filesystem::path& folder);

  std::map<std::filesystem::path, Folder> folders_;
};

}  // namespace tureen
