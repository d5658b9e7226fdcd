#include "viewer/files/file_watch.hpp"

#include <utility>

namespace tureen::viewer {

namespace {

namespace fs = std::filesystem;

/// Largest number of watched files in a folder, so that a check stays cheap.
constexpr int max_files = 256;

/// The mixing step of splitmix64: every bit of the input affects every bit of the result.
std::uint64_t mixed(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

std::uint64_t print_of(const fs::path& file) {
  std::error_code failed;
  const auto time = fs::last_write_time(file, failed);
  const auto size = failed ? 0 : fs::file_size(file, failed);
  if (failed) return 0;
  const auto ticks = static_cast<std::uint64_t>(time.time_since_epoch().count());
  return mixed(mixed(ticks) + size) + fs::hash_value(file);
}

}  // namespace

FileWatch::FileWatch(fs::path path)
    : path_(std::move(path)), known_(fingerprint()), last_(known_) {}

std::uint64_t FileWatch::fingerprint() const {
  std::error_code failed;
  if (!fs::is_directory(path_, failed)) return path_.empty() ? 0 : print_of(path_);
  std::uint64_t sum = 0;
  int count = 0;
  for (fs::directory_iterator entry(path_, failed), end; !failed && entry != end;
       entry.increment(failed)) {
    if (entry->is_regular_file(failed)) sum += print_of(entry->path());
    if (++count == max_files) break;
  }
  return sum;
}

bool FileWatch::changed() {
  const std::uint64_t now = fingerprint();
  const bool at_rest = now == std::exchange(last_, now);
  if (now == 0 || now == known_ || !at_rest) return false;
  known_ = now;
  return true;
}

}  // namespace tureen::viewer
