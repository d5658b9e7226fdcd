// What tests of faults share: disks that are full, moments of a run, and what is on the disk
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

/// `tureen` in `folder`, where what is in its folder `disk` lies on a disk of `kilobytes`
/// meanwhile: a file system of its own, which only the program sees. Its files as they are
/// afterwards come into the folder `after`; those in `disk` stay. Where the system does not let
/// people mount, as in many a container, the exit code is no_disk.
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
/// base/output_path.hpp), and tells how many that were.
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

/// Looks out for a moment of a child; made before the child starts, so that nothing it does passes
/// unseen.
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

  /// Waits for the moment, or for the child's end. A child that writes stands still then, with what
  /// it writes begun and not yet in its place. Tells whether the moment came.
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
          // Until it stood still it may have come to the end of that.
          if (is_being_written()) return true;
          child.signal(SIGCONT);
      }
    }
    return false;
  }

 private:
  /// Returns once a name was made in the folder, sooner than looking again and again does, or after
  /// a hundredth of a second.
  void wait_for_a_name() const {
    pollfd ready{.fd = names_, .events = POLLIN, .revents = 0};
    ::poll(&ready, 1, 10);
    char events[4096];
    while (::read(names_, events, sizeof events) > 0) continue;
  }

  /// Whether something stands beside the path that will have its name. A new folder swaps names
  /// with the old one, which has the temporary name then until all in it is removed.
  bool is_being_written() const {
    const std::string beginning = path_.filename().string() + ".tmp";
    std::error_code vanished;  // while it is looked at
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
  int old_;  // held open: while it is, no newer file is given its identity
  ino_t before_;
  int names_;
};

/// As `kill` does, also to a child that stands still.
inline void end_by(int number, Child& child) {
  child.signal(number);
  child.signal(SIGCONT);
}

}  // namespace tureen::test
