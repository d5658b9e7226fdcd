#include "formats/archive/zip_archive.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>

#include "base/little_endian.hpp"
#include "formats/archive/inflater.hpp"

namespace tureen {

namespace {

constexpr std::uint32_t local_signature = 0x04034b50;
constexpr std::uint32_t central_signature = 0x02014b50;
constexpr std::uint32_t end_signature = 0x06054b50;
constexpr std::uint32_t end64_signature = 0x06064b50;
constexpr std::uint32_t locator64_signature = 0x07064b50;
constexpr std::size_t local_size = 30, central_size = 46, end_size = 22, end64_size = 56,
                      locator64_size = 20;

}  // namespace

ZipArchive::ZipArchive(Input input) : input_(std::move(input)) {
  const Directory directory = find_directory();
  // A record takes at least 46 bytes, so a false count is rejected before any allocation.
  if (directory.offset > input_.size() || directory.size > input_.size() - directory.offset)
    input_.fail_at(directory.offset, "the zip directory does not lie within the file");
  if (directory.entries > directory.size / central_size)
    input_.fail_at(directory.offset, "a zip directory of " + std::to_string(directory.size) +
                                         " bytes cannot hold " + std::to_string(directory.entries) +
                                         " entries");
  input_.seek(directory.offset);
  const auto bytes = input_.read_values<std::byte>(directory.size, "the zip directory");
  // The entries copy the names from the directory, so its size counts twice.
  input_.take_memory(directory.size, 1, "the zip directory");
  input_.make_room_in(entries_, directory.entries, "the zip directory");
  std::size_t at = 0;
  for (std::uint64_t i = 0; i < directory.entries; ++i) {
    const auto rest = std::span(bytes).subspan(at);
    const std::uint64_t place = directory.offset + at;
    if (rest.size() < central_size || little_number(rest, 0, 4) != central_signature)
      input_.fail_at(place, "entry " + std::to_string(i) + " of the zip directory is damaged");
    const std::size_t length = central_size + static_cast<std::size_t>(little_number(rest, 28, 2)) +
                               static_cast<std::size_t>(little_number(rest, 30, 2)) +
                               static_cast<std::size_t>(little_number(rest, 32, 2));
    if (length > rest.size())
      input_.fail_at(place, "entry " + std::to_string(i) + " of the zip directory is cut short");
    read_entry(rest.first(length), place, directory.offset);
    at += length;
  }
  std::sort(entries_.begin(), entries_.end(),
            [](const ZipEntry& a, const ZipEntry& b) { return a.name < b.name; });
  for (std::size_t i = 1; i < entries_.size(); ++i)
    if (entries_[i].name == entries_[i - 1].name) fail_in(entries_[i], "occurs twice");
}

ZipArchive::Directory ZipArchive::find_directory() {
  // The end record is the last 22 bytes plus a comment of at most 65,535. The search goes
  // backwards.
  if (input_.size() < end_size) input_.fail_at(0, "too short for a zip archive");
  const std::uint64_t window = std::min<std::uint64_t>(input_.size(), end_size + 65535);
  const std::uint64_t start = input_.size() - window;
  input_.seek(start);
  const auto tail = input_.read_values<std::byte>(window, "the end of the zip archive");
  for (std::size_t at = tail.size() - end_size + 1; at-- > 0;) {
    const auto record = std::span(tail).subspan(at);
    if (little_number(record, 0, 4) != end_signature ||
        little_number(record, 20, 2) != record.size() - end_size)
      continue;
    const std::uint64_t place = start + at;
    if (little_number(record, 4, 2) != 0 && little_number(record, 4, 2) != 0xffff)
      input_.fail_at(place, "a zip archive in several parts");
    const Directory directory{little_number(record, 16, 4), little_number(record, 12, 4),
                              little_number(record, 10, 2)};
    const bool overflows = directory.offset == 0xffffffff || directory.size == 0xffffffff ||
                           directory.entries == 0xffff;
    if (!overflows) return directory;
    return place < locator64_size ? directory : find_zip64_directory(place - locator64_size);
  }
  input_.fail_at(input_.size(),
                 "the zip directory is missing: the file is cut short or is not a zip archive");
}

ZipArchive::Directory ZipArchive::find_zip64_directory(std::uint64_t locator) {
  std::array<std::byte, end64_size> record;
  input_.seek(locator);
  input_.read(std::span(record).first(locator64_size), "the zip64 locator");
  if (little_number(record, 0, 4) != locator64_signature)
    input_.fail_at(locator, "the zip64 locator is missing");
  const std::uint64_t end = little_number(record, 8, 8);
  input_.seek(end);
  input_.read(record, "the zip64 end record");
  if (little_number(record, 0, 4) != end64_signature)
    input_.fail_at(end, "the zip64 end record is missing");
  return {little_number(record, 48, 8), little_number(record, 40, 8), little_number(record, 32, 8)};
}

void ZipArchive::read_entry(std::span<const std::byte> record, std::uint64_t at,
                            std::uint64_t directory) {
  ZipEntry entry;
  const auto name_size = static_cast<std::size_t>(little_number(record, 28, 2));
  const auto extra_size = static_cast<std::size_t>(little_number(record, 30, 2));
  entry.name.assign(reinterpret_cast<const char*>(record.data()) + central_size, name_size);
  entry.compressed_size = little_number(record, 20, 4);
  entry.size = little_number(record, 24, 4);
  entry.header = little_number(record, 42, 4);
  const std::string quoted = "zip entry \"" + entry.name + "\" ";

  // Zip64: the fields with the value 0xffffffff follow in this order in extra field 1.
  auto extra = record.subspan(central_size + name_size, extra_size);
  while (extra.size() >= 4) {
    const std::size_t length = static_cast<std::size_t>(little_number(extra, 2, 2));
    if (length > extra.size() - 4) break;
    if (little_number(extra, 0, 2) == 1) {
      auto values = extra.subspan(4, length);
      for (std::uint64_t* field : {&entry.size, &entry.compressed_size, &entry.header}) {
        if (*field != 0xffffffff) continue;
        if (values.size() < 8) input_.fail_at(at, quoted + "lacks its zip64 sizes");
        *field = little_number(values, 0, 8);
        values = values.subspan(8);
      }
    }
    extra = extra.subspan(4 + length);
  }

  if (little_number(record, 8, 2) & 1) input_.fail_at(at, quoted + "is encrypted");
  const std::uint64_t method = little_number(record, 10, 2);
  if (method != 0 && method != 8)
    input_.fail_at(at, quoted + "is compressed by method " + std::to_string(method) +
                           ", only 0 (stored) and 8 (deflated) are supported");
  entry.method = method == 0 ? ZipEntry::Method::stored : ZipEntry::Method::deflated;
  if (entry.header > directory || directory - entry.header < local_size ||
      entry.compressed_size > directory - entry.header - local_size)
    input_.fail_at(at, quoted + "does not lie before the zip directory");
  if (entry.method == ZipEntry::Method::stored && entry.size != entry.compressed_size)
    input_.fail_at(at, quoted + "is stored, yet its two sizes differ");
  if (entry.method == ZipEntry::Method::deflated) {
    if (entry.size > max_inflated_bytes)
      input_.fail_at(at, quoted + "would inflate to " + std::to_string(entry.size) +
                             " bytes, the limit is " + std::to_string(max_inflated_bytes));
    // No deflate stream expands beyond 1032 : 1 (258 bytes from two bits).
    if (entry.size / 1032 > entry.compressed_size)
      input_.fail_at(at, quoted + "claims more bytes than it can inflate to");
  }
  entries_.push_back(std::move(entry));
}

const ZipEntry* ZipArchive::find(std::string_view name) const {
  const auto found =
      std::lower_bound(entries_.begin(), entries_.end(), name,
                       [](const ZipEntry& e, std::string_view wanted) { return e.name < wanted; });
  return found != entries_.end() && found->name == name ? &*found : nullptr;
}

std::uint64_t ZipArchive::data_offset(const ZipEntry& entry) {
  // The local header repeats name and extra field with other lengths: torch pads them.
  std::array<std::byte, local_size> header;
  input_.seek(entry.header);
  input_.read(header, "a zip entry's header");
  if (little_number(header, 0, 4) != local_signature) fail_in(entry, "has a damaged header");
  const std::uint64_t offset =
      entry.header + local_size + little_number(header, 26, 2) + little_number(header, 28, 2);
  if (offset > input_.size() || entry.compressed_size > input_.size() - offset)
    fail_in(entry, "does not lie within the file");
  return offset;
}

void ZipArchive::read(const ZipEntry& entry, std::uint64_t offset, std::span<std::byte> out) {
  assert(offset <= entry.size && out.size() <= entry.size - offset);
  if (entry.method == ZipEntry::Method::deflated) return inflate(entry, offset, out);
  input_.seek(data_offset(entry) + offset);
  input_.read(out, "a zip entry");
}

void ZipArchive::inflate(const ZipEntry& entry, std::uint64_t offset, std::span<std::byte> out) {
  input_.seek(data_offset(entry));
  Inflater inflater(input_, Inflater::Wrapper::none, entry.compressed_size);
  const auto fill = [&](std::span<std::byte> bytes) {
    if (inflater.read(bytes) < bytes.size())
      fail_in(entry, "is damaged: its deflated data ends early or is invalid");
  };
  std::array<std::byte, 65536> skipped;
  for (std::uint64_t rest = offset; rest > 0;) {
    const auto part = std::span(skipped).first(
        static_cast<std::size_t>(std::min<std::uint64_t>(rest, skipped.size())));
    fill(part);
    rest -= part.size();
  }
  fill(out);
}

std::vector<std::byte> ZipArchive::read_all(const ZipEntry& entry, std::uint64_t limit) {
  if (entry.size > limit)
    fail_in(entry, "holds " + std::to_string(entry.size) + " bytes, the limit is " +
                       std::to_string(limit));
  input_.take_memory(entry.size, 1, "a zip entry");
  std::vector<std::byte> bytes(static_cast<std::size_t>(entry.size));
  read(entry, 0, bytes);
  return bytes;
}

void ZipArchive::fail_in(const ZipEntry& entry, const std::string& reason) const {
  input_.fail_at(entry.header, "zip entry \"" + entry.name + "\" " + reason);
}

}  // namespace tureen
