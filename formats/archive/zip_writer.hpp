// A zip archive of stored files (PKWARE APPNOTE 6.3), for formats whose files are compressed
// already. Not supported: deflating, archives of 4 GiB and more.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/output.hpp"

namespace tureen {

class ZipWriter {
 public:
  /// The content of each file begins at a multiple of `alignment`, a power of two; USDZ has 64. The
  /// output must be empty, and must outlive the writer.
  explicit ZipWriter(Output& output, std::size_t alignment = 1)
      : output_(output), alignment_(alignment) {}

  /// `name` with / between folders. Throws OutputError, also if the archive becomes too large.
  void add(const std::string& name, std::span<const std::byte> content);
  /// Writes the directory; nothing may follow. The caller commits the output.
  void finish();

 private:
  struct Entry {
    std::string name;
    std::uint32_t sum, size, header;
  };
  void number(std::uint64_t value, int bytes);
  void head(const Entry& entry);

  Output& output_;
  std::size_t alignment_;
  std::vector<Entry> entries_;
};

}  // namespace tureen
