#include "base/output.hpp"

#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include "base/output_path.hpp"
#include "base/platform/system.hpp"

namespace tureen {

namespace {

std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

}  // namespace

Output::Output(std::filesystem::path path) : path_(std::move(path)) {
#ifndef __EMSCRIPTEN__  // its file system has no links, permissions or devices
  path_ = writable_file(path_);
#endif
  temporary_ = temporary_beside(path_);
  file_ = std::fopen(temporary_.c_str(), "wb");
  const int reason = errno;
  std::error_code none;
  // The new file keeps the permissions of the old one.
  if (const auto old = std::filesystem::status(path_, none); file_ && std::filesystem::exists(old))
    std::filesystem::permissions(temporary_, old.permissions(), none);
  if (file_) return;
  const std::filesystem::path folder = path_.parent_path();
  std::error_code error;
  if (!folder.empty() && !std::filesystem::exists(folder, error))
    throw OutputError({path_.string()}, "there is no folder " + folder.string());
  errno = reason;
  fail("cannot be created");
}

Output::~Output() {
  if (!file_) return;
  std::fclose(file_);
  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);
}

void Output::write(std::span<const std::byte> bytes) {
  if (bytes.empty()) return;  // an empty span may have no address, which fwrite does not allow
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) fail("cannot be written");
  position_ += bytes.size();
}

void Output::write(std::string_view text) { write(bytes_of(text)); }

void Output::commit() {
  std::error_code error, ignored;
  if (std::fflush(file_) != 0) fail("cannot be written");
  if (std::fclose(std::exchange(file_, nullptr)) != 0) {
    std::filesystem::remove(temporary_, ignored);
    fail("cannot be written");
  }
  std::filesystem::rename(temporary_, path_, error);
  if (!error) return;
  std::filesystem::remove(temporary_, ignored);
  throw OutputError({path_.string()}, "cannot be replaced: " + error.message());
}

void Output::fail(const char* what) const {
  throw OutputError({path_.string()}, std::string(what) + ": " + std::strerror(errno));
}

void write_file(const std::filesystem::path& path, std::string_view text) {
  write_file(path, bytes_of(text));
}

void write_file(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  Output output(path);
  output.write(bytes);
  output.commit();
}

void replace_folder(const std::filesystem::path& made, const std::filesystem::path& path) {
  namespace fs = std::filesystem;
  std::error_code error, ignored;
  if (fs::exists(path, ignored) && swap_names(made, path)) {
    fs::remove_all(made, ignored);
    return;
  }
  // Some systems and disks cannot swap names. Then `path` is missing for a moment.
  fs::path old = made;
  old += ".old";
  const bool replaces = fs::exists(path, ignored);
  if (replaces) fs::rename(path, old, error);
  if (!error) {
    fs::rename(made, path, error);
    if (error && replaces) fs::rename(old, path, ignored);
  }
  if (error) throw OutputError({path.string()}, "cannot be replaced: " + error.message());
  if (replaces) fs::remove_all(old, ignored);
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder, error))
    throw OutputError({folder.string()}, "cannot be created as a folder" +
                                             (error ? ": " + error.message() : std::string()));
}

}  // namespace tureen
