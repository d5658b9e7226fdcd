// Untrusted deflated bytes (RFC 1951), decompressed in order as they are requested, so that the
// caller bounds their number. zlib needs a fixed memory of about 40 KB.
#pragma once

#include <zlib.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "base/input.hpp"

namespace tureen {

class Inflater {
 public:
  enum class Wrapper { none, gzip };  // gzip: RFC 1952, with its checksum

  /// Reads at most `packed` bytes of the input, from its position on. The input must outlive the
  /// Inflater, and nothing else may read from it. Throws std::bad_alloc.
  Inflater(Input& input, Wrapper wrapper, std::uint64_t packed);
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;
  ~Inflater();

  /// Fills `out` and returns its size, or less where the data end or are damaged. Throws InputError
  /// if the input ends within `packed` bytes.
  std::size_t read(std::span<std::byte> out);

  /// Whether read() has reached the end of complete and undamaged data.
  bool at_end() const { return status_ == Z_STREAM_END; }

 private:
  Input& input_;
  std::uint64_t packed_;
  z_stream stream_{};
  int status_;
  std::array<std::byte, 65536> source_;
};

}  // namespace tureen
