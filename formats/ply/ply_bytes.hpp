// The values of a binary PLY body, as they are written.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "base/output.hpp"

namespace tureen {

/// Writes values as little-endian bytes on any machine, in blocks.
class PlyBytes {
 public:
  explicit PlyBytes(Output& output) : output_(output) { bytes_.reserve(block + 16); }
  void byte(unsigned value) {
    bytes_.push_back(static_cast<std::byte>(value & 0xff));
    if (bytes_.size() >= block) flush();
  }
  void word(std::uint32_t value) {
    for (int shift = 0; shift < 32; shift += 8) byte(value >> shift);
  }
  void real(float value) {
    std::uint32_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    word(bits);
  }
  void flush() {
    output_.write(bytes_);
    bytes_.clear();
  }

 private:
  static constexpr std::size_t block = 64 * 1024;
  Output& output_;
  std::vector<std::byte> bytes_;
};

}  // namespace tureen
