// What a reader may cost, whatever it is given.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/memory_budget.hpp"
#include "tests/formats/format_testing.hpp"
#include "tests/formats/memory_limit.hpp"
#include "tests/formats/memory_meter.hpp"

namespace tureen::test {

using Bytes = std::vector<std::byte>;

/// What readers have beside what they count: windows on texts (256 kB), blocks, a PLY header (1 MB)
/// in pieces, the tables of coders, errors and what GoogleTest keeps of them.
inline constexpr std::size_t uncounted = 4 << 20;

/// Longer than any read of a few kilobytes takes, even on a busy machine and with sanitizers; a
/// read whose time grows with a number in the file takes minutes.
inline constexpr double longest_read = 20;

/// What reads took at most.
struct Cost {
  std::size_t bytes = 0;  // of `new`
  double seconds = 0;
};

/// Calls `read` with no more memory than `limit`, and holds it to that.
template <class Read>
Cost within_bounds(std::uint64_t limit, Read&& read, const std::string& what) {
  const MemoryLimit scoped(limit);
  const MemoryMeter meter;
  const auto start = std::chrono::steady_clock::now();
  read();
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  const Cost cost{meter.peak(), seconds.count()};
  EXPECT_LT(cost.bytes, limit + uncounted) << what;
  EXPECT_LT(cost.seconds, longest_read) << what;
  return cost;
}

inline std::string text_of(const Bytes& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

inline Bytes bytes_of(const std::string& text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

/// Reading ends in an InputError like this, having allocated next to nothing.
template <class Read>
void expect_refused(Read&& read, const std::string& what,
                    const ::testing::Matcher<std::optional<Refusal>>& expected) {
  std::optional<Refusal> error;
  within_bounds(
      default_max_memory,
      [&] {
        const MemoryMeter meter;
        error = error_of(read);
        EXPECT_LT(meter.peak(), uncounted) << what;
      },
      what);
  EXPECT_THAT(error, expected) << what;
}

}  // namespace tureen::test
