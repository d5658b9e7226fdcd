#include "splatting/depth_order.hpp"

#include <array>
#include <cstddef>
#include <cstring>
#include <utility>

namespace tureen::splatting {

namespace {

// Three passes over 11 bits were the fastest of 8, 11 and 16 bits for 100,000 splats.
constexpr int digit_bits = 11;
constexpr std::size_t digits = 3;
constexpr std::uint32_t digit_values = 1u << digit_bits;

std::uint32_t digit(std::uint32_t key, std::size_t place) {
  return (key >> (place * digit_bits)) & (digit_values - 1);
}

}  // namespace

std::uint32_t depth_key(float depth) {
  if (depth == 0.0f) depth = 0.0f;  // of -0
  std::uint32_t bits = 0;
  std::memcpy(&bits, &depth, sizeof bits);  // Emscripten's library lacks std::bit_cast
  return bits & 0x80000000u ? ~bits : bits | 0x80000000u;
}

/// Least significant digit first, which keeps the order of equal keys.
void sort_by_depth(std::vector<DepthKey>& keys, std::vector<DepthKey>& scratch) {
  std::array<std::array<std::uint32_t, digit_values>, digits> counts{};
  for (const DepthKey& key : keys)
    for (std::size_t place = 0; place < digits; ++place) ++counts[place][digit(key.key, place)];
  scratch.resize(keys.size());
  for (std::size_t place = 0; place < digits; ++place) {
    std::array<std::uint32_t, digit_values>& next = counts[place];
    std::uint32_t sum = 0;
    for (std::uint32_t& count : next) sum += std::exchange(count, sum);
    for (const DepthKey& key : keys) scratch[next[digit(key.key, place)]++] = key;
    keys.swap(scratch);
  }
}

}  // namespace tureen::splatting
