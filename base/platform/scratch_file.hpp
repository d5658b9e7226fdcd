// A temporary file without a name, for bytes that memory should not hold. The system removes it
// with its last user, however that ends. Needs POSIX.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

namespace tureen {

class ScratchFile {
 public:
  /// Throws OutputError if no file can be made in scratch_folder().
  ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
  ~ScratchFile();

  /// Returns the place of the bytes. Throws OutputError if the disk is full. Not thread-safe.
  std::uint64_t append(std::span<const std::byte> bytes);
  /// Fills `bytes` from a place. Thread-safe. Throws InputError if the disk fails.
  void read(std::uint64_t place, std::span<std::byte> bytes) const;
  /// Lets the system read ahead, and returns at once. Thread-safe.
  void expect(std::uint64_t place, std::uint64_t size) const;

  std::uint64_t size() const { return size_; }

 private:
  int file_ = -1;
  std::uint64_t size_ = 0;
};

/// TMPDIR if it is set; else /var/tmp, which is on a disk where /tmp is often in memory.
std::filesystem::path scratch_folder();

}  // namespace tureen
