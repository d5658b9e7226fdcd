// Bytes that are in memory, or in a file and read when they are needed. Copies share them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace tureen {

class ScratchFile;

class StoredBytes {
 public:
  StoredBytes() = default;
  StoredBytes(std::vector<std::uint8_t> bytes)
      : memory_(std::make_shared<const std::vector<std::uint8_t>>(std::move(bytes))),
        size_(memory_->size()) {}

  bool empty() const { return size_ == 0; }
  std::size_t size() const { return size_; }
  /// The file that has the bytes; null if they are in memory.
  const std::shared_ptr<ScratchFile>& file() const { return file_; }

  /// The bytes. Throws InputError if the file cannot be read.
  std::vector<std::uint8_t> operator()() const;
  /// Appends the bytes to the file, unless they are in one, and frees the memory with its last
  /// copy. Throws OutputError if the disk is full.
  void move_to(const std::shared_ptr<ScratchFile>& file);
  /// Drops all but the first `size` bytes; a file keeps them. Copies keep them, too.
  void shorten(std::size_t size);
  /// Lets the system read ahead.
  void expect() const;

 private:
  std::shared_ptr<const std::vector<std::uint8_t>> memory_;
  std::shared_ptr<ScratchFile> file_;
  std::size_t size_ = 0;
  std::uint64_t place_ = 0;
};

}  // namespace tureen
