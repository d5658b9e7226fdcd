// A file that is complete or absent: written under a temporary name, then renamed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <span>
#include <string_view>

#include "base/error.hpp"

namespace tureen {

class Output {
 public:
  /// Opens a temporary file beside the path that writable_file() returns (output_path.hpp). Throws
  /// OutputError if that fails, and the errors of writable_file().
  explicit Output(std::filesystem::path path);
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;
  /// Removes the temporary file unless commit() has succeeded.
  ~Output();

  void write(std::span<const std::byte> bytes);
  void write(std::string_view text);
  template <class T>
  void write_value(const T& value) {
    write(std::as_bytes(std::span(&value, 1)));
  }
  std::uint64_t position() const { return position_; }

  /// Flushes, closes and renames to `path`. On failure, throws OutputError; `path` is then
  /// unchanged.
  void commit();

 private:
  [[noreturn]] void fail(const char* what) const;

  std::filesystem::path path_;  // with links resolved
  std::filesystem::path temporary_;
  std::FILE* file_ = nullptr;
  std::uint64_t position_ = 0;
};

/// Writes a complete file. Throws OutputError.
void write_file(const std::filesystem::path& path, std::string_view text);
void write_file(const std::filesystem::path& path, std::span<const std::byte> bytes);

/// Moves the folder `made` to `path` and removes the folder that was there. If the system can swap
/// two names (Linux), `path` names one of the two folders at every moment. On failure, throws
/// OutputError; `path` is then unchanged.
void replace_folder(const std::filesystem::path& made, const std::filesystem::path& path);

/// Creates a folder and its missing parents. Throws OutputError.
void make_folder(const std::filesystem::path& folder);

}  // namespace tureen
