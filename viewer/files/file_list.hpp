// The scenes, datasets and folders in a folder, for the window that opens files.
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
  std::vector<FileEntry> entries;  // folders first, by name; without hidden ones
  bool cut = false;                // the folder has more
  bool has_photographs = false;    // and neither scenes nor cameras
  std::string trouble;             // error of listing it; empty if none
  std::string typed;               // text in the field for paths
  std::string typed_trouble;       // why that path cannot be opened; empty if it can
};

/// Largest number of listed entries.
inline constexpr std::size_t max_entries = 2000;

/// Folders, and files with the name of a scene or a dataset. Errors are in FileList::trouble.
FileList list_files(const std::filesystem::path& folder);

/// The path of FileList::typed. A relative one begins in the listed folder.
std::filesystem::path typed_path(const FileList& files);

}  // namespace tureen::viewer
