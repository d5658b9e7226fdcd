#include "base/output_path.hpp"

#include <atomic>
#include <chrono>
#include <cstdio>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

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

namespace {

constexpr const char* temporary_mark = ".tmp";

#ifndef __EMSCRIPTEN__  // one process, and no threads for a mutex

/// The process of a name that temporary_beside() made; nullopt for other names.
std::optional<int> process_of(const std::string& name) {
  const std::size_t mark = name.rfind(temporary_mark);
  int process = 0, end = 0;
  if (mark == std::string::npos ||
      std::sscanf(name.c_str() + mark, ".tmp%9d-%*9u%n", &process, &end) != 1 || process <= 0 ||
      mark + std::size_t(end) != name.size())
    return {};
  return process;
}

/// Files and folders of killed processes in this folder, which is searched once: an animation
/// writes thousands of files.
std::vector<fs::path> leftovers_in(const fs::path& folder) {
  static std::mutex mutex;
  static std::map<fs::path, std::vector<fs::path>> known;
  const std::lock_guard lock(mutex);
  const auto [found, is_new] = known.try_emplace(folder);
  std::error_code error;
  if (is_new)
    for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
      if (const auto process = process_of(it->path().filename().string());
          process && !is_process(*process))
        found->second.push_back(it->path());
  return found->second;
}

void remove_leftovers(const fs::path& path) {
  const std::string own = path.filename().string() + temporary_mark;
  const fs::path folder = path.parent_path();
  std::error_code ignored;
  // Without a file at `path`, the temporary one may be all that is left of it.
  if (!fs::exists(path, ignored)) return;
  for (const fs::path& left : leftovers_in(folder.empty() ? "." : folder)) {
    const std::string name = left.filename().string();
    if (!name.starts_with(own) || name.find(temporary_mark, own.size()) != std::string::npos)
      continue;
    // A computer that shares the folder may be writing it: its processes are unknown here.
    const auto written = fs::last_write_time(left, ignored);
    if (!ignored && fs::file_time_type::clock::now() - written > std::chrono::hours(1) &&
        !is_process(process_of(name).value_or(0)))
      fs::remove_all(left, ignored);
  }
}

#else
void remove_leftovers(const fs::path&) {}
#endif

}  // namespace

fs::path temporary_beside(const fs::path& path) {
  static std::atomic<unsigned> counter{0};
  remove_leftovers(path);
  fs::path name = path;
  name += temporary_mark + std::to_string(process_id()) + "-" + std::to_string(counter++);
  return name;
}

}  // namespace tureen
