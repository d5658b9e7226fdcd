#include "base/input.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace tureen {

namespace {

std::string plural(std::uint64_t count) {
  return std::to_string(count) + (count == 1 ? " byte" : " bytes");
}

}  // namespace

Input Input::open(const std::filesystem::path& path, MemoryBudget budget) {
  Input input(path.string(), std::move(budget));
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found)
    throw InputError({input.name_}, "no such file");
  if (!std::filesystem::status_known(status))  // a cycle of links, a long name, no permission
    throw InputError({input.name_}, "cannot be looked up: " + error.message());
  if (!std::filesystem::is_regular_file(status))
    throw InputError({input.name_}, std::filesystem::is_directory(status)
                                        ? "is a folder, expected a file"
                                        : "is a pipe or a device, expected a file");
  input.size_ = std::filesystem::file_size(path, error);
  if (error) throw InputError({input.name_}, "cannot be read: " + error.message());
  input.file_.reset(std::fopen(path.c_str(), "rb"));
  if (!input.file_)
    throw InputError({input.name_}, std::string("cannot be opened: ") + std::strerror(errno));
  return input;
}

Input Input::memory(std::string name, std::span<const std::byte> bytes, MemoryBudget budget) {
  Input input(std::move(name), std::move(budget));
  input.bytes_ = bytes;
  input.size_ = bytes.size();
  return input;
}

void Input::seek(std::uint64_t position) {
  if (position > size_)
    fail("the data at byte " + std::to_string(position) + " lies past the end of the file at " +
         std::to_string(size_));
  if (file_ && fseeko(file_.get(), static_cast<off_t>(position), SEEK_SET) != 0)
    fail(std::string("cannot seek: ") + std::strerror(errno));
  position_ = position;
}

std::size_t Input::read_some(std::span<std::byte> buffer) {
  const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(buffer.size(), remaining()));
  if (count == 0) return 0;
  if (file_) {
    const std::size_t got = std::fread(buffer.data(), 1, count, file_.get());
    if (got < count && std::ferror(file_.get()))
      fail(std::string("cannot be read: ") + std::strerror(errno));
    position_ += got;
    // The file has shrunk since it was opened.
    if (got < count) size_ = position_;
    return got;
  }
  std::memcpy(buffer.data(), bytes_.data() + position_, count);
  position_ += count;
  return count;
}

void Input::read(std::span<std::byte> buffer, const char* what) {
  if (buffer.size() > remaining()) fail_truncated(buffer.size(), 1, what);
  if (read_some(buffer) < buffer.size()) fail(std::string("the file ends within ") + what);
}

std::vector<std::byte> Input::read_rest() {
  take_memory(remaining(), 1, "the file");
  std::vector<std::byte> bytes(static_cast<std::size_t>(remaining()));
  bytes.resize(read_some(bytes));
  return bytes;
}

std::string Input::read_text() {
  const std::vector<std::byte> bytes = read_rest();
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void Input::fail(const std::string& reason, const std::string& hint) const {
  fail_at(position_, reason, hint);
}

void Input::fail_at(std::uint64_t byte, const std::string& reason, const std::string& hint) const {
  throw InputError({name_, byte, {}}, reason, hint);
}

void Input::fail_truncated(std::uint64_t count, std::size_t each, const char* what) const {
  const std::string want = each == 1 ? plural(count) : std::to_string(count) + " x " + plural(each);
  fail(std::string(what) + " truncated: " + want + " expected, " + plural(remaining()) + " left");
}

}  // namespace tureen
