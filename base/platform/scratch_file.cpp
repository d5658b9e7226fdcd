#include "base/platform/scratch_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <string>
#include <system_error>

#include "base/error.hpp"

namespace tureen {

namespace {

[[noreturn]] void refuse_bytes(const char* what, int reason) {
  throw OutputError({scratch_folder().string()},
                    what + (": " + std::generic_category().message(reason)),
                    "TMPDIR names another folder");
}

}  // namespace

std::filesystem::path scratch_folder() {
  if (const char* chosen = std::getenv("TMPDIR"); chosen && *chosen) return chosen;
  std::error_code error;
  const std::filesystem::path on_disk = "/var/tmp";
  return std::filesystem::is_directory(on_disk, error)
             ? on_disk
             : std::filesystem::temp_directory_path(error);
}

ScratchFile::ScratchFile() {
  std::string name = scratch_folder() / "tureen-XXXXXX";
  // A program that starts meanwhile does not inherit it.
  file_ = mkostemp(name.data(), O_CLOEXEC);
  if (file_ < 0) refuse_bytes("no temporary file can be made here", errno);
  unlink(name.c_str());
}

ScratchFile::~ScratchFile() { close(file_); }

std::uint64_t ScratchFile::append(std::span<const std::byte> bytes) {
  const std::uint64_t place = size_;
  while (!bytes.empty()) {
    const ssize_t count = pwrite(file_, bytes.data(), bytes.size(), off_t(size_));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) refuse_bytes("the temporary file cannot grow", count < 0 ? errno : ENOSPC);
    bytes = bytes.subspan(std::size_t(count));
    size_ += std::uint64_t(count);
  }
  return place;
}

void ScratchFile::read(std::uint64_t place, std::span<std::byte> bytes) const {
  while (!bytes.empty()) {
    const ssize_t count = pread(file_, bytes.data(), bytes.size(), off_t(place));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0)
      throw InputError({scratch_folder().string()},
                       "the temporary file cannot be read: " +
                           std::generic_category().message(count < 0 ? errno : EIO));
    bytes = bytes.subspan(std::size_t(count));
    place += std::uint64_t(count);
  }
}

void ScratchFile::expect([[maybe_unused]] std::uint64_t place,
                         [[maybe_unused]] std::uint64_t size) const {
#ifdef POSIX_FADV_WILLNEED
  posix_fadvise(file_, off_t(place), off_t(size), POSIX_FADV_WILLNEED);
#endif
}

}  // namespace tureen
