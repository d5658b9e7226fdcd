#include "viewer/files/file_list.hpp"

#include <algorithm>

#include "base/extension.hpp"
#include "formats/scene_file.hpp"
#include "jobs/cameras/camera_run.hpp"

namespace tureen::viewer {

namespace {

namespace fs = std::filesystem;

bool has_scene_name(const fs::path& path) {
  for (const FormatInfo& format : known_formats())
    for (const std::string& extension : format.read_extensions)
      if (extension_of(path) == extension) return true;
  return path.filename() == "transforms.json";
}

}  // namespace

FileList list_files(const fs::path& folder) {
  FileList list;
  list.folder = folder;
  std::error_code failed;
  for (fs::directory_iterator entry(folder, failed), end; !failed && entry != end;
       entry.increment(failed)) {
    if (entry->path().filename().string().starts_with('.')) continue;
    std::error_code ignored;
    const bool is_folder = entry->is_directory(ignored);
    if (!is_folder && !has_scene_name(entry->path())) continue;
    if (list.entries.size() == max_entries) {
      list.cut = true;
      break;
    }
    list.entries.push_back({entry->path(), is_folder});
  }
  if (failed) list.trouble = failed.message();
  const auto is_folder = [](const FileEntry& entry) { return entry.is_folder; };
  list.has_photographs =
      std::all_of(list.entries.begin(), list.entries.end(), is_folder) && is_photographs(folder);
  std::sort(list.entries.begin(), list.entries.end(), [](const FileEntry& a, const FileEntry& b) {
    return a.is_folder != b.is_folder ? a.is_folder : a.path.filename() < b.path.filename();
  });
  return list;
}

fs::path typed_path(const FileList& files) {
  const fs::path path = (files.folder / files.typed).lexically_normal();
  return path.has_filename() ? path : path.parent_path();  // without the last slash
}

}  // namespace tureen::viewer
