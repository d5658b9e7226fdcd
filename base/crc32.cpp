#include "base/crc32.hpp"

#include <array>

namespace tureen {

namespace {

constexpr std::size_t lanes = 8;

/// [k][b]: the sum of byte b and k zeros after it.
using Tables = std::array<std::array<std::uint32_t, 256>, lanes>;

Tables made_tables() {
  Tables sums;
  for (std::uint32_t b = 0; b < 256; ++b) {
    std::uint32_t sum = b;
    for (int bit = 0; bit < 8; ++bit) sum = sum >> 1 ^ (sum & 1 ? 0xedb88320u : 0u);
    sums[0][b] = sum;
  }
  for (std::size_t k = 1; k < lanes; ++k)
    for (std::size_t b = 0; b < 256; ++b)
      sums[k][b] = sums[0][sums[k - 1][b] & 0xff] ^ sums[k - 1][b] >> 8;
  return sums;
}

}  // namespace

std::uint32_t crc32_of(std::span<const std::byte> bytes) {
  // Made by the first call: as constants, they would be 7 KB of the page.
  static const Tables tables = made_tables();
  const auto at = [&](std::size_t i) { return std::to_integer<std::uint32_t>(bytes[i]); };
  std::uint32_t sum = ~0u;
  for (; bytes.size() >= lanes; bytes = bytes.subspan(lanes)) {
    sum ^= at(0) | at(1) << 8 | at(2) << 16 | at(3) << 24;
    sum = tables[7][sum & 0xff] ^ tables[6][sum >> 8 & 0xff] ^ tables[5][sum >> 16 & 0xff] ^
          tables[4][sum >> 24] ^ tables[3][at(4)] ^ tables[2][at(5)] ^ tables[1][at(6)] ^
          tables[0][at(7)];
  }
  for (const std::byte byte : bytes)
    sum = tables[0][(sum ^ std::to_integer<std::uint32_t>(byte)) & 0xff] ^ sum >> 8;
  return ~sum;
}

}  // namespace tureen
