#include "image/codecs/jpeg_tables.hpp"

namespace tureen {

namespace {

constexpr unsigned soi = 0xd8, sos = 0xda, dht = 0xc4;

class Segments {
 public:
  explicit Segments(std::span<const std::byte> bytes) : bytes_(bytes) {}

  std::optional<OversizedTable> oversized() const {
    std::size_t begin = 0;  // any number of 0xff bytes may precede a marker code
    while (byte(begin) == 0xff && byte(begin + 1) == 0xff) ++begin;
    if (byte(begin) != 0xff || byte(begin + 1) != soi) return std::nullopt;
    // Before the first scan, decoders skip segments by their lengths. A table inside a segment, as
    // in an embedded thumbnail, is therefore not read. After the first scan, a decoder may take any
    // damaged bytes for the next marker.
    bool in_header = true;
    for (std::size_t at = begin + 2; at + 1 < bytes_.size(); ++at) {
      const unsigned marker = byte(at + 1);
      if (byte(at) != 0xff || marker == 0xff || marker == 0) continue;
      if (marker == dht && is_oversized(at + 2)) return OversizedTable{at, in_header};
      if (marker == sos) in_header = false;
      if (in_header) at += 1 + length(at + 2);  // to the last byte of the segment
    }
    return std::nullopt;
  }

 private:
  /// 0 beyond the end, as in stb.
  unsigned byte(std::size_t at) const {
    return at < bytes_.size() ? std::to_integer<unsigned>(bytes_[at]) : 0;
  }
  std::size_t length(std::size_t at) const { return byte(at) << 8 | byte(at + 1); }

  /// Whether a table in a segment has more than 256 codes. `at` is the position of the segment's
  /// length.
  bool is_oversized(std::size_t at) const {
    // The last table may extend past the segment. Not all decoders check this before reading it.
    const std::size_t end = at + length(at);
    for (at += 2; at < end;) {
      std::size_t codes = 0;
      for (std::size_t i = 1; i <= 16; ++i) codes += byte(at + i);
      if (codes > 256) return true;
      at += 17 + codes;
    }
    return false;
  }

  std::span<const std::byte> bytes_;
};

}  // namespace

std::optional<OversizedTable> oversized_huffman_table(std::span<const std::byte> bytes) {
  return Segments(bytes).oversized();
}

}  // namespace tureen
