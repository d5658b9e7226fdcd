// What a folder holds that can be opened: the list behind the window that files are picked in.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tureen::viewer {

struct FileEntry {
  std::filesystem::path path;
  bool is_folder = false;
};

struct FileList {
  std::filesystem::path folder;    // empty: none yet
  std::vector<FileEntry> entries;  // folders first, by name; nothing hidden
  bool cut = false;                // there are more
  std::string trouble;             // why it could not be listed; empty where it could
  std::string typed;               // into the field for paths
};

/// A folder with more is cut off.
inline constexpr std::size_t max_entries = 2000;

/// Folders, and files that have a scene's or a dataset's name. What cannot be listed says so.
FileList list_files(const std::filesystem::path& folder);

}  // namespace tureen::viewer
