// What tests of faults share: a disk that is full, moments of a run, and what is on the disk
// afterwards.
#pragma once

#include <poll.h>
#include <sys/inotify.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "cli/child.hpp"

namespace tureen::test {

/// Children that start meanwhile cannot write a file beyond so many bytes: to them the disk is
/// full.
class SmallDisk {
 public:
  explicit SmallDisk(rlim_t bytes) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;
  ~SmallDisk() { ::setrlimit(RLIMIT_FSIZE, &before_); }

 private:
  rlimit before_{};
};

inline std::string bytes_of_file(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// A file's bytes by "", or those of a folder's files by their names.
inline std::map<std::string, std::string> contents_of(const std::filesystem::path& path) {
  if (!std::filesystem::is_directory(path)) return {{"", bytes_of_file(path)}};
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(path))
    files[entry.path().filename().string()] = bytes_of_file(entry.path());
  return files;
}

/// All that is in `folder` and below it, by its path from there.
inline std::vector<std::string> names_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    names.push_back(std::filesystem::relative(entry.path(), folder).string());
  std::sort(names.begin(), names.end());
  return names;
}

/// Removes what a program that was killed had half written (temporary_beside in
/// formats/output_path.hpp), and tells how many that were.
inline int remove_temporaries(const std::filesystem::path& folder) {
  int removed = 0;
  for (const std::string& name : names_in(folder))
    if (name.find(".tmp") != std::string::npos && std::filesystem::remove_all(folder / name) > 0)
      ++removed;
  return removed;
}

/// When a program is ended: at a time after its start, or once it has done something.
struct Moment {
  enum class Until { nothing, written, replaced };
  std::chrono::microseconds after{0};
  Until until = Until::nothing;
  std::string path;  // which is being written, or has been replaced
};

/// `count` moments from the very beginning of a program to behind its end, where `run` is how long
/// it takes at least. Every second one is in the first third: whoever else works on the machine
/// makes the program slower, and one that goes on from a checkpoint has less to do.
inline std::vector<Moment> moments_of(std::chrono::microseconds run, int count,
                                      std::minstd_rand& random) {
  std::vector<Moment> moments;
  for (int i = 0; i < count; ++i) {
    const double within = double(random() - std::minstd_rand::min()) / std::minstd_rand::max();
    const double share = i == 0 ? 0.0 : (i + within) / count;  // one in each of `count` parts
    moments.push_back({.after = std::chrono::microseconds(
                           static_cast<std::int64_t>(1.3 * double(run.count()) * share * share)),
                       .path = {}});
  }
  return moments;
}

/// Which file or folder a name stands for: another one after it was replaced.
inline ino_t identity_of(const std::filesystem::path& path) {
  struct stat status {};
  return ::stat(path.c_str(), &status) == 0 ? status.st_ino : 0;
}

/// Whether something is being written that will have this name.
inline bool is_being_written(const std::filesystem::path& path) {
  const std::string beginning = path.filename().string() + ".tmp";
  std::error_code vanished;  // while it is looked at
  std::filesystem::directory_iterator entry(path.parent_path(), vanished);
  for (; !vanished && entry != std::filesystem::directory_iterator(); entry.increment(vanished))
    if (entry->path().filename().string().rfind(beginning, 0) == 0) return true;
  return false;
}

/// Wakes whoever waits for a name to be made in a folder, sooner than looking again and again does.
class NewNames {
 public:
  explicit NewNames(const std::filesystem::path& folder)
      : queue_(::inotify_init1(IN_NONBLOCK | IN_CLOEXEC)) {
    ::inotify_add_watch(queue_, folder.c_str(), IN_CREATE);
  }
  NewNames(const NewNames&) = delete;
  NewNames& operator=(const NewNames&) = delete;
  ~NewNames() { ::close(queue_); }

  /// Returns once one was made, or after a hundredth of a second.
  void wait() const {
    pollfd ready{.fd = queue_, .events = POLLIN, .revents = 0};
    ::poll(&ready, 1, 10);
    char events[4096];
    while (::read(queue_, events, sizeof events) > 0) continue;
  }

 private:
  int queue_;
};

/// Waits for a moment of the child, or for its end. A child that writes stands still then, with
/// what it writes begun and not yet in its place. Tells whether the moment came.
inline bool wait_for(const Moment& moment, Child& child, const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / moment.path;
  const ino_t before = identity_of(path);
  const NewNames names(folder);
  std::this_thread::sleep_for(moment.after);
  while (child.running()) {
    switch (moment.until) {
      case Moment::Until::nothing:
        return true;
      case Moment::Until::replaced:
        if (identity_of(path) != before) return true;
        std::this_thread::yield();
        break;
      case Moment::Until::written:
        names.wait();
        if (!is_being_written(path)) break;
        child.stop();
        // Until it stood still it may have come to the end of that.
        if (is_being_written(path)) return true;
        child.signal(SIGCONT);
    }
  }
  return false;
}

/// As `kill` does, also to a child that stands still.
inline void end_by(int number, Child& child) {
  child.signal(number);
  child.signal(SIGCONT);
}

}  // namespace tureen::test
