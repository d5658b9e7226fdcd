// Untrusted zip archives, read through their central directory (PKWARE APPNOTE 6.3): stored and
// deflated entries, zip64. Torch checkpoints are such archives.
//
// Not supported: writing, decryption, multi-part archives, repair, and checksums. Checksums are
// ignored because torch can save without them and reads such files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/input.hpp"

namespace tureen {

struct ZipEntry {
  enum class Method { stored, deflated };
  std::string name;
  Method method = Method::stored;
  std::uint64_t size = 0;             // of the content
  std::uint64_t compressed_size = 0;  // in the archive; inside the file
  std::uint64_t header = 0;           // offset of the local header
};

class ZipArchive {
 public:
  /// Largest size of a deflated entry; larger ones are rejected, so that a small file cannot
  /// request all memory. The file itself limits a stored entry.
  static constexpr std::uint64_t max_inflated_bytes = std::uint64_t(1) << 31;

  /// Reads the central directory. Throws InputError if it is damaged, an entry lies outside the
  /// file, two entries have the same name, or an entry is encrypted or uses another compression
  /// method.
  explicit ZipArchive(Input input);

  /// For its name and its budget.
  Input& input() { return input_; }
  const std::string& name() const { return input_.name(); }
  const MemoryBudget& budget() const { return input_.budget(); }
  const std::vector<ZipEntry>& entries() const { return entries_; }
  /// Null if there is none.
  const ZipEntry* find(std::string_view name) const;

  /// Fills `out` with the content from byte `offset` on; offset + out.size() <= entry.size. Only
  /// the requested part of a stored entry is read; a deflated one is read from its beginning.
  void read(const ZipEntry& entry, std::uint64_t offset, std::span<std::byte> out);

  /// The whole content. Throws InputError if it exceeds `limit` bytes.
  std::vector<std::byte> read_all(const ZipEntry& entry, std::uint64_t limit);

  [[noreturn]] void fail_in(const ZipEntry& entry, const std::string& reason) const;

 private:
  struct Directory {
    std::uint64_t offset, size, entries;
  };
  Directory find_directory();
  Directory find_zip64_directory(std::uint64_t locator);
  void read_entry(std::span<const std::byte> record, std::uint64_t at, std::uint64_t directory);
  std::uint64_t data_offset(const ZipEntry& entry);
  void inflate(const ZipEntry& entry, std::uint64_t offset, std::span<std::byte> out);

  Input input_;
  std::vector<ZipEntry> entries_;  // sorted by name
};

}  // namespace tureen
