// The inflated stream of a PNG, as a browser's decompressor returns it.
#pragma once

#include <zlib.h>

#include <cstddef>
#include <vector>

#include "image/deflated_png.hpp"

namespace tureen::test {

/// Empty if the stream is damaged or has another size than the image needs.
inline std::vector<std::byte> inflated(const DeflatedPng& png) {
  std::vector<std::byte> packed;
  for (const auto& piece : png.pieces) packed.insert(packed.end(), piece.begin(), piece.end());
  std::vector<std::byte> stream(png.inflated_bytes());
  uLongf size = uLongf(stream.size());
  const int result =
      uncompress(reinterpret_cast<Bytef*>(stream.data()), &size,
                 reinterpret_cast<const Bytef*>(packed.data()), uLong(packed.size()));
  return result == Z_OK && size == stream.size() ? stream : std::vector<std::byte>();
}

}  // namespace tureen::test
