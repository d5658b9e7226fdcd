// SPZ files of every version, byte by byte.
#pragma once

#include <zlib.h>
#include <zstd.h>

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/formats/torch_fixture.hpp"

namespace tureen::test {

inline std::string gzipped(std::string content) {
  z_stream stream{};
  if (deflateInit2(&stream, 9, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY) != Z_OK)
    throw std::runtime_error("deflateInit2");
  std::string packed(deflateBound(&stream, static_cast<uLong>(content.size())), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(content.data());
  stream.avail_in = static_cast<uInt>(content.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  deflate(&stream, Z_FINISH);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

inline std::string zstd_packed(const std::string& content) {
  std::string packed(ZSTD_compressBound(content.size()), '\0');
  packed.resize(ZSTD_compress(packed.data(), packed.size(), content.data(), content.size(), 3));
  return packed;
}

struct SpzFixture {
  unsigned version = 4;
  std::uint64_t splats = 1;
  unsigned degree = 0, fractional_bits = 12, flags = 0;
  /// positions, alphas, colors, scales, rotations, harmonics
  std::array<std::string, 6> arrays = {};
  std::string extensions = {}, trailing = {};

  SpzFixture& extension(std::uint32_t type, const std::string& content) {
    flags |= 2;
    append_little(extensions, type, 4);
    append_little(extensions, content.size(), 4);
    extensions += content;
    return *this;
  }

  /// The file; of versions 1 to 3 before its compression.
  std::string content() const {
    std::vector<std::string> used;
    for (const std::string& array : arrays)
      if (!array.empty()) used.push_back(array);
    std::string out = "NGSP";
    append_little(out, version, 4);
    append_little(out, splats, 4);
    for (const std::uint64_t value : {degree, fractional_bits, flags}) append_little(out, value, 1);
    append_little(out, version < 4 ? 0 : used.size(), 1);
    if (version < 4) {
      for (const std::string& array : used) out += array;
      return out + extensions + trailing;
    }
    append_little(out, 32 + extensions.size(), 4);
    out += std::string(12, '\0') + extensions;
    std::string streams;
    for (const std::string& array : used) {
      const std::string packed = zstd_packed(array);
      append_little(out, packed.size(), 8);
      append_little(out, array.size(), 8);
      streams += packed;
    }
    return out + streams + trailing;
  }
  std::string bytes() const { return version < 4 ? gzipped(content()) : content(); }
};

/// A splat with the centre (1.5, -2.25, 0.5) on the axes of SPZ, the scales (1, e^-1, e^-10), and
/// harmonics that are k + c * 40 + 1 for coefficient k from 1 on and channel c.
inline SpzFixture spz_splat(unsigned version, unsigned degree) {
  SpzFixture spz{.version = version, .degree = degree};
  if (version == 1) {
    for (const unsigned half : {0x3e00u, 0xc080u, 0x3800u}) append_little(spz.arrays[0], half, 2);
  } else {
    for (const int fixed : {6144, -9216, 2048})
      append_little(spz.arrays[0], static_cast<std::uint32_t>(fixed), 3);
  }
  spz.arrays[1] = "\x33";  // 51
  spz.arrays[2] = std::string("\x00\xff\x33", 3);
  spz.arrays[3] = std::string("\xa0\x90\x00", 3);  // 160, 144, 0
  if (version < 3)
    spz.arrays[4] = "\xbf\x40\x80";  // 191, 64, 128
  else
    append_little(spz.arrays[4], 1u << 30 | 300u << 20 | 512u << 10 | 100u << 10 | 511u, 4);
  for (unsigned k = 1; k < (degree + 1) * (degree + 1); ++k)
    for (unsigned c = 0; c < 3; ++c) spz.arrays[5] += static_cast<char>(k + c * 40 + 1);
  return spz;
}

}  // namespace tureen::test
