#include "formats/output_path.hpp"

#include <string>

#include "soup/error.hpp"

#ifdef _WIN32
#include <io.h>
#define access _access
constexpr int may_write = 2;
#else
#include <unistd.h>
constexpr int may_write = W_OK;
#endif

namespace tureen {

namespace fs = std::filesystem;

fs::path followed(const fs::path& path) {
  constexpr int most_links = 40;  // as Linux follows in one path
  fs::path target = path;
  for (int i = 0; i < most_links; ++i) {
    std::error_code none;
    const fs::path next = fs::read_symlink(target, none);
    if (none) break;
    target = target.parent_path() / next;  // which is `next` where that is absolute
  }
  return target;
}

fs::path writable_file(const fs::path& path) {
  const auto fail = [&](const std::string& reason) {
    throw OutputError({path.string(), {}, {}}, reason);
  };
  if (path.empty()) throw UsageError("the name of an output is empty");
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::status_known(status)) fail("cannot be written: " + error.message());
  if (!fs::exists(status)) return followed(path);
  if (fs::is_directory(status)) fail("cannot be written: it is a folder");
  if (!fs::is_regular_file(status))
    fail("cannot be written: it is a pipe or a device, and only files are replaced");
  if (access(path.c_str(), may_write) != 0) fail("cannot be replaced: it is write-protected");
  return followed(path);
}

}  // namespace tureen
