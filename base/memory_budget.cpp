#include "base/memory_budget.hpp"

#include <array>
#include <atomic>
#include <cassert>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <string_view>

#include "base/decimal.hpp"
#include "base/decimal_text.hpp"

namespace tureen {

namespace {

// Atomic, because the window reads on a separate thread.
std::atomic<std::uint64_t> process_limit{default_max_memory};

struct Unit {
  std::string_view letter;
  int bits;
};
constexpr std::array<Unit, 5> units{{{"", 0}, {"k", 10}, {"m", 20}, {"g", 30}, {"t", 40}}};

/// "GB", "GiB", "G" and "g" are the same unit; null if `word` is not a unit.
const Unit* unit_of(std::string word) {
  for (char& c : word) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (word == "byte" || word == "bytes") word.clear();
  if (!word.empty() && word.back() == 'b') word.pop_back();
  if (word.size() == 2 && word.back() == 'i') word.pop_back();
  for (const Unit& unit : units)
    if (unit.letter == word) return &unit;
  return nullptr;
}

}  // namespace

void set_max_memory(std::uint64_t bytes) { process_limit = bytes; }
std::uint64_t max_memory() { return process_limit; }

std::uint64_t parse_memory_size(const std::string& text) {
  const auto refuse = [&] {
    throw UsageError("'" + text + "' is not a memory size", "write it as 512MiB or 8GiB");
  };
  const Decimal number = parse_decimal(text);
  if (!number.end) refuse();
  std::string_view rest(number.end);
  while (!rest.empty() && rest.front() == ' ') rest.remove_prefix(1);
  const Unit* unit = unit_of(std::string(rest));
  if (!unit) refuse();
  // A float would round whole numbers above 24 bits.
  const double value = number.is_integer ? double(parse_integer(text).value) : double(number.value);
  const double bytes = std::ldexp(value, unit->bits);
  // 2^62 exceeds any machine's memory, and the sum of two such sizes fits into 64 bits.
  if (!(bytes >= 1 && bytes <= std::ldexp(1.0, 62))) refuse();
  return static_cast<std::uint64_t>(bytes);
}

std::string memory_size_text(std::uint64_t bytes) {
  static constexpr std::array<const char*, 5> names{"", "KiB", "MiB", "GiB", "TiB"};
  std::size_t unit = 0;
  while (unit + 1 < units.size() && bytes >> units[unit + 1].bits > 0) ++unit;
  if (unit == 0) return counted(bytes, "byte");
  char text[32];
  std::snprintf(text, sizeof text, "%.4g %s", std::ldexp(double(bytes), -units[unit].bits),
                names[unit]);
  return text;
}

MemoryBudget::MemoryBudget(std::uint64_t limit)
    : count_(std::make_shared<Count>(Count{limit, 0})) {}

bool MemoryBudget::take(std::uint64_t elements, std::size_t each) {
  if (each != 0 && elements > left() / each) return false;
  count_->taken += elements * each;
  return true;
}

void MemoryBudget::give_back(std::uint64_t bytes) {
  assert(bytes <= count_->taken);
  count_->taken -= bytes;
}

std::string MemoryBudget::refusal(const std::string& what) const {
  return what + " would exceed the limit of " + memory_size_text(limit()) +
         " on memory for reading";
}

}  // namespace tureen
