#include "base/existing_path.hpp"

#include <algorithm>
#include <string>

#include "base/error.hpp"
#include "base/suggestion.hpp"

namespace tureen {

namespace fs = std::filesystem;

bool is_missing(const fs::path& path) {
  std::error_code ignored;
  return fs::status(path, ignored).type() == fs::file_type::not_found;
}

void require_there(const fs::path& path) {
  const auto fail = [&](const std::string& reason, const std::string& hint = {}) {
    throw InputError({path.string()}, reason, hint);
  };
  if (path.empty()) throw UsageError("the name of an input is empty");
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) {
    std::error_code none;
    const fs::path target = fs::read_symlink(path, none);
    if (!none) fail("is a link to " + target.string() + ", which does not exist");
    fail(why_missing(path), did_you_mean(path));
  }
  if (!fs::status_known(status)) fail("cannot be looked up: " + error.message());
  // Without this check, files in a folder that cannot be entered would seem to be missing.
  if (fs::is_directory(status) && !fs::status_known(fs::status(path / ".", error)))
    fail("cannot be opened: " + error.message());
}

Input open_existing(const fs::path& path) {
  require_there(path);
  return Input::open(path);
}

bool lies_in(const fs::path& path, const fs::path& folder) {
  std::error_code error;
  const fs::path outer = fs::weakly_canonical(fs::absolute(folder, error), error);
  if (error) return false;
  const fs::path inner = fs::weakly_canonical(fs::absolute(path, error), error);
  if (error) return false;
  return std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end();
}

}  // namespace tureen
