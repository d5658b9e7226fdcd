// Shared by the tests of faults: full disks, moments of a run, and the files on the disk
// afterwards.
#pragma once

#include <fcntl.h>
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
#include <map>
#include <random>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/cli/child.hpp"

namespace tureen::test {

/// While it exists, new children cannot write a file of more than `bytes`, as on a full disk.
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

/// Runs `tureen` in `folder`, with the folder `disk` on a disk of `kilobytes`. That is a separate
/// file system, visible only to the program. Its files are afterwards in the folder `after`; those
/// in `disk` stay as they were. If the system does not allow users to mount, as in many containers,
/// the exit code is no_disk.
inline constexpr int no_disk = 77;
inline ChildResult run_on_disk(int kilobytes, const std::vector<std::string>& arguments,
                               const std::filesystem::path& folder) {
  const std::string mount = R"(
    cp -a disk before || exit 1
    mount -t tmpfs -o size="$1" tmpfs disk || exit )" +
                            std::to_string(no_disk) + R"(
    cp -a before/. disk && rm -r before || exit 1
    shift
    "$@"
    code=$?
    rm -rf after
    cp -a disk after && exit $code)";
  std::vector<std::string> words{"-c",
                                 "unshare -rm true || exit " + std::to_string(no_disk) +
                                     R"(; exec unshare -rm sh -c "$0" sh "$@")",
                                 mount, std::to_string(kilobytes) + "k", TUREEN_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return Child(words, folder, "/bin/sh").wait();
}

/// The bytes of a file under the name "", or those of a folder's files under their names.
inline std::map<std::string, std::string> contents_of(const std::filesystem::path& path) {
  if (!std::filesystem::is_directory(path)) return {{"", bytes_of_file(path)}};
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(path))
    files[entry.path().filename().string()] = bytes_of_file(entry.path());
  return files;
}

/// Everything in `folder` and below it, as paths relative to it.
inline std::vector<std::string> names_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    names.push_back(std::filesystem::relative(entry.path(), folder).string());
  std::sort(names.begin(), names.end());
  return names;
}

/// Removes the half-written files of a killed program (temporary_beside in base/output_path.hpp),
/// and returns their number.
inline int remove_temporaries(const std::filesystem::path& folder) {
  int removed = 0;
  for (const std::string& name : names_in(folder))
    if (name.find(".tmp") != std::string::npos && std::filesystem::remove_all(folder / name) > 0)
      ++removed;
  return removed;
}

/// When to end a program: at a time after its start, or at an event after that time.
struct Moment {
  enum class Until { nothing, written, replaced };
  std::chrono::microseconds after{0};
  Until until = Until::nothing;
  std::string path;  // the file of the event
};

/// `count` moments from the start of a program to beyond its end; `run` is its shortest duration.
/// Half of them are in the first third. On a busy machine the program is slower, and a program that
/// resumes from a checkpoint has less to do.
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

/// The identity of the file or folder with this name. It changes when the file is replaced.
inline ino_t identity_of(const std::filesystem::path& path) {
  struct stat status {};
  return ::stat(path.c_str(), &status) == 0 ? status.st_ino : 0;
}

/// Detects a moment of a child. Create it before the child starts, so that it misses no event.
class Lookout {
 public:
  Lookout(Moment moment, const std::filesystem::path& folder)
      : moment_(std::move(moment)),
        path_(folder / moment_.path),
        old_(::open(path_.c_str(), O_PATH | O_CLOEXEC)),
        before_(identity_of(path_)),
        names_(::inotify_init1(IN_NONBLOCK | IN_CLOEXEC)) {
    ::inotify_add_watch(names_, folder.c_str(), IN_CREATE);
  }
  Lookout(const Lookout&) = delete;
  Lookout& operator=(const Lookout&) = delete;
  ~Lookout() {
    ::close(names_);
    if (old_ >= 0) ::close(old_);
  }

  /// Waits for the moment, or for the child's end. At Until::written, it stops the child, whose
  /// file is begun and not yet in its place. Returns whether the moment came.
  bool wait_for(Child& child) const {
    std::this_thread::sleep_for(moment_.after);
    while (child.running()) {
      switch (moment_.until) {
        case Moment::Until::nothing:
          return true;
        case Moment::Until::replaced:
          if (identity_of(path_) != before_) return true;
          std::this_thread::yield();
          break;
        case Moment::Until::written:
          wait_for_a_name();
          if (!is_being_written()) break;
          child.stop();
          // The child may have finished the file before it stopped.
          if (is_being_written()) return true;
          child.signal(SIGCONT);
      }
    }
    return false;
  }

 private:
  /// Returns once a name appears in the folder, or after 10 ms. This is faster than polling the
  /// folder.
  void wait_for_a_name() const {
    pollfd ready{.fd = names_, .events = POLLIN, .revents = 0};
    ::poll(&ready, 1, 10);
    char events[4096];
    while (::read(names_, events, sizeof events) > 0) continue;
  }

  /// Whether a temporary file for the path exists. A new folder swaps names with the old one. The
  /// old one then has the temporary name until all its files are removed.
  bool is_being_written() const {
    const std::string beginning = path_.filename().string() + ".tmp";
    std::error_code vanished;  // during the iteration
    std::filesystem::directory_iterator entry(path_.parent_path(), vanished);
    for (; !vanished && entry != std::filesystem::directory_iterator(); entry.increment(vanished)) {
      if (entry->path().filename().string().rfind(beginning, 0) != 0) continue;
      const ino_t identity = identity_of(entry->path());
      if (identity != 0 && identity != before_) return true;
    }
    return false;
  }

  Moment moment_;
  std::filesystem::path path_;
  int old_;  // while it is open, no newer file gets its identity
  ino_t before_;
  int names_;
};

/// Sends the signal as `kill` does, also to a stopped child.
inline void end_by(int number, Child& child) {
  child.signal(number);
  child.signal(SIGCONT);
}

}  // namespace tureen::test
