// Bounds on the cost of a reader, for any input.
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

/// Memory in bytes that readers use beyond their count: windows on texts (256 kB), blocks, a PLY
/// header (1 MB) in pieces, tables of coders, errors, and GoogleTest's copies.
inline constexpr std::size_t uncounted = 4 << 20;

/// Bound in seconds for reading a few kilobytes, on a busy machine and with sanitizers. A read
/// whose time grows with a number in the file takes minutes.
inline constexpr double longest_read = 20;

/// The maximal cost of reads.
struct Cost {
  std::size_t bytes = 0;  // allocated by `new`
  double seconds = 0;
};

/// Calls `read` under the memory limit `limit`, and checks that it stays within it.
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

/// Expects that reading throws this InputError and allocates almost nothing.
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
