#include "base/radix_sort.hpp"

#include <array>
#include <cstddef>
#include <cstring>
#include <utility>

namespace tureen {

namespace {

// Three passes over 11 bits were the fastest of 8, 11 and 16 bits for 100,000 splats.
constexpr int digit_bits = 11;
constexpr std::size_t digits = 3;
constexpr std::uint32_t digit_values = 1u << digit_bits;

std::uint32_t digit(std::uint32_t key, std::size_t place) {
  return (key >> (place * digit_bits)) & (digit_values - 1);
}

}  // namespace

std::uint32_t sort_key(float value) {
  if (value == 0.0f) value = 0.0f;  // of -0
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);  // Emscripten's library lacks std::bit_cast
  return bits & 0x80000000u ? ~bits : bits | 0x80000000u;
}

/// Least significant digit first, which keeps the order of equal keys.
void radix_sort(std::vector<KeyedIndex>& items, std::vector<KeyedIndex>& scratch) {
  std::array<std::array<std::uint32_t, digit_values>, digits> counts{};
  for (const KeyedIndex& item : items)
    for (std::size_t place = 0; place < digits; ++place) ++counts[place][digit(item.key, place)];
  scratch.resize(items.size());
  for (std::size_t place = 0; place < digits; ++place) {
    std::array<std::uint32_t, digit_values>& next = counts[place];
    std::uint32_t sum = 0;
    for (std::uint32_t& count : next) sum += std::exchange(count, sum);
    for (const KeyedIndex& item : items) scratch[next[digit(item.key, place)]++] = item;
    items.swap(scratch);
  }
}

}  // namespace tureen
