// Zip archives from untrusted hands, read by way of their central directory (PKWARE APPNOTE 6.3):
// stored and deflated entries, zip64. Torch checkpoints are such archives.
//
// Does not: write, decrypt, read archives in several parts, repair, or compare checksums (torch can
// be told to save without them, and reads such files back).
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
  std::uint64_t compressed_size = 0;  // of the bytes in the archive, all within the file
  std::uint64_t header = 0;           // byte of the local header
};

class ZipArchive {
 public:
  /// A deflated entry that claims to hold more is refused, so that a small file cannot ask for all
  /// memory there is. A stored entry is bounded by the file itself.
  static constexpr std::uint64_t max_inflated_bytes = std::uint64_t(1) << 31;

  /// Reads the central directory. Throws InputError when it is damaged, when an entry does not lie
  /// within the file, when two have the same name, or when one is encrypted or packed in a way
  /// other than the two above.
  explicit ZipArchive(Input input);

  const std::string& name() const { return input_.name(); }
  const MemoryBudget& budget() const { return input_.budget(); }
  const std::vector<ZipEntry>& entries() const { return entries_; }
  /// Null when there is none.
  const ZipEntry* find(std::string_view name) const;

  /// Fills `out` with the content from byte `offset` on; offset + out.size() <= entry.size. A
  /// stored entry is read there and nowhere else, a deflated one from its beginning.
  void read(const ZipEntry& entry, std::uint64_t offset, std::span<std::byte> out);

  /// The whole content; throws InputError when that is over `limit` bytes.
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
