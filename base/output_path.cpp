#include "base/output_path.hpp"

#include <atomic>
#include <string>

#include "base/error.hpp"
#include "base/platform/system.hpp"

namespace tureen {

namespace fs = std::filesystem;

fs::path followed(const fs::path& path) {
  constexpr int max_links = 40;  // Linux's limit per path
  fs::path target = path;
  for (int i = 0; i < max_links; ++i) {
    std::error_code none;
    const fs::path next = fs::read_symlink(target, none);
    if (none) break;
    target = target.parent_path() / next;  // `next` if it is absolute
  }
  return target;
}

fs::path writable_file(const fs::path& path) {
  const auto fail = [&](const std::string& reason) { throw OutputError({path.string()}, reason); };
  if (path.empty()) throw UsageError("the name of an output is empty");
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::status_known(status)) fail("cannot be written: " + error.message());
  if (!fs::exists(status)) return followed(path);
  if (fs::is_directory(status)) fail("cannot be written: it is a folder");
  if (!fs::is_regular_file(status))
    fail("cannot be written: it is a pipe or a device, and only files are replaced");
  if (!may_write(path)) fail("cannot be replaced: it is write-protected");
  return followed(path);
}

fs::path writable_folder(const fs::path& path) {
  std::error_code error;
  if (fs::is_directory(path, error) && !may_write(path))
    throw OutputError({path.string()}, "cannot be replaced: it is write-protected");
  return followed(path);
}

fs::path temporary_beside(const fs::path& path) {
  static std::atomic<unsigned> counter{0};
  fs::path name = path;
  name += ".tmp" + std::to_string(process_id()) + "-" + std::to_string(counter++);
  return name;
}

}  // namespace tureen
