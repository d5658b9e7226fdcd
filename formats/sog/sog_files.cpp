#include "formats/sog/sog_files.hpp"

#include <system_error>
#include <utility>

#include "formats/common/uri.hpp"

namespace tureen {

namespace fs = std::filesystem;

SogFiles::SogFiles(const fs::path& path) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) {
    folder_ = path;
  } else {
    Input input = Input::open(path);
    std::byte first{};
    if (input.read_some(std::span(&first, 1)) == 1 && first == std::byte('P')) {
      input.seek(0);
      archive_.emplace(std::move(input));
      return;
    }
    folder_ = path.has_parent_path() ? path.parent_path() : fs::path(".");
  }
  place_.emplace(Input::memory(path.string(), {}));
}

SogFiles::SogFiles(Input archive) : archive_(std::in_place, std::move(archive)) {}

bool SogFiles::has(const std::string& name) const {
  if (archive_) return archive_->find(name) != nullptr;
  std::error_code ignored;
  return fs::is_regular_file(folder_ / name, ignored);
}

bool SogFiles::may_gain(const std::string& name) const {
  if (archive_) return false;
  try {
    resolve_name_in_folder(folder_, name);
  } catch (const UriError&) {
    return false;
  }
  return true;
}

std::vector<std::byte> SogFiles::read(const std::string& name) {
  if (!archive_) return open_in_folder(folder_, name, place_->budget()).read_rest();
  const ZipEntry* entry = archive_->find(name);
  if (!entry) throw InputError({shown(name)}, "this file is missing in the archive");
  return archive_->read_all(*entry, ZipArchive::max_inflated_bytes);
}

std::uint64_t SogFiles::size_of(const std::string& name) const {
  if (archive_) {
    const ZipEntry* entry = archive_->find(name);
    return entry ? entry->compressed_size : 0;
  }
  std::error_code failed;
  const std::uintmax_t size = fs::file_size(folder_ / name, failed);
  return failed ? 0 : size;
}

std::string SogFiles::shown(const std::string& name) const {
  return archive_ ? archive_->name() + "/" + name : (folder_ / name).string();
}

}  // namespace tureen
