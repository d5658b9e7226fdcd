#include "trainer/common/run_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "base/error.hpp"

namespace tureen::trainer {

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

RunLock::RunLock(std::filesystem::path file) : file_(std::move(file)) {
  for (;;) {
    descriptor_ = open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor_ < 0)
      throw OutputError({file_.string(), {}, {}},
                        std::string("cannot be written: ") + std::strerror(errno));
    if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      close(descriptor_);
      throw UsageError("another run is writing the files beside " + file_.string(),
                       "wait for it, stop it, or choose another name with -o");
    }
    if (is_still(descriptor_, file_)) return;
    close(descriptor_);
  }
}

RunLock::~RunLock() {
  unlink(file_.c_str());  // before the lock is released: the next run then creates a new file
  close(descriptor_);
}

}  // namespace tureen::trainer
