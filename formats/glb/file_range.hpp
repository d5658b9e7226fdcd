// Bytes of a file.
#pragma once

#include <cstdint>

namespace tureen {

struct FileRange {
  std::uint64_t offset = 0;
  std::uint64_t size = 0;
  std::uint64_t end() const { return offset + size; }
  bool operator==(const FileRange&) const = default;
};

}  // namespace tureen
