// A file that appears whole or not at all: written under a temporary name, then renamed.
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
  /// Opens a temporary file beside writable_file (output_path.hpp) and throws as that does.
  explicit Output(std::filesystem::path path);
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;
  /// Removes the temporary file unless commit() was reached.
  ~Output();

  void write(std::span<const std::byte> bytes);
  void write(std::string_view text);
  template <class T>
  void write_value(const T& value) {
    write(std::as_bytes(std::span(&value, 1)));
  }
  std::uint64_t position() const { return position_; }

  /// Flushes, closes and renames over `path`. Throws OutputError; `path` is then untouched.
  void commit();

 private:
  [[noreturn]] void fail(const char* what) const;

  std::filesystem::path path_;  // with links followed
  std::filesystem::path temporary_;
  std::FILE* file_ = nullptr;
  std::uint64_t position_ = 0;
};

/// A whole file. Throws OutputError.
void write_file(const std::filesystem::path& path, std::string_view text);
void write_file(const std::filesystem::path& path, std::span<const std::byte> bytes);

/// Puts the folder `made` in the place of `path`, of which a folder that was there is removed.
/// Where the system can swap two names (Linux) one of them is at `path` at every moment. Throws
/// OutputError; `path` is then untouched.
void replace_folder(const std::filesystem::path& made, const std::filesystem::path& path);

/// Makes a folder, and those above it, where they are not there. Throws OutputError.
void make_folder(const std::filesystem::path& folder);

}  // namespace tureen
