#include "base/platform/file_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include "base/error.hpp"

namespace tureen {

namespace {

/// Whether this descriptor is still the file with that name. The previous holder of the lock may
/// have removed the file between our open and flock.
bool is_still(int descriptor, const std::filesystem::path& file) {
  struct stat ours {
  }, named{};
  return fstat(descriptor, &ours) == 0 && stat(file.c_str(), &named) == 0 &&
         ours.st_ino == named.st_ino && ours.st_dev == named.st_dev;
}

}  // namespace

FileLock::FileLock(std::filesystem::path file) : file_(std::move(file)) {
  for (;;) {
    descriptor_ = open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor_ < 0)
      throw OutputError({file_.string()},
                        std::string("cannot be written: ") + std::strerror(errno));
    const bool is_locked = flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    if (!is_locked && is_still(descriptor_, file_)) return;
    close(std::exchange(descriptor_, -1));
    if (is_locked) return;
  }
}

FileLock::~FileLock() {
  if (!is_held()) return;
  unlink(file_.c_str());  // before the lock is released: the next process then creates a new file
  close(descriptor_);
}

}  // namespace tureen
