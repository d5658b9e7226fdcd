#include "trainer/common/config_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/decimal.hpp"
#include "base/suggestion.hpp"

namespace tureen::trainer {

namespace {

std::string limit_text(double value) {
  return value == std::floor(value) && value < 1e15 ? std::to_string((long long)value)
                                                    : float_text(float(value));
}

}  // namespace

bool Range::contains(double value) const {
  const bool above = ends == Ends::low_open ? value > low : value >= low;
  const bool below = ends == Ends::high_open ? value < high : value <= high;
  return above && below;  // both are false for NaN
}

std::string Range::text() const {
  switch (ends) {
    case Ends::low_open:
      return "more than " + limit_text(low) + ", at most " + limit_text(high);
    case Ends::high_open:
      return "from " + limit_text(low) + " to less than " + limit_text(high);
    case Ends::closed:
      break;
  }
  return "from " + limit_text(low) + " to " + limit_text(high);
}

std::string Range::refusal(double value, const std::string& written) const {
  return written + " is out of range; allowed: " + text() + " (" +
         (value > high ? reason_above : reason) + ")";
}

std::string double_text(double value) { return fmt::format("{}", value); }

void require_known_fields(const JsonView& root, std::span<const std::string> names) {
  const std::vector<std::string> known(names.begin(), names.end());
  std::string unknown, hint;
  for (const auto& [key, ignored] : root.value().items())
    if (std::find(known.begin(), known.end(), key) == known.end()) {
      unknown += (unknown.empty() ? "\"" : "; \"") + key + "\" is not a training constant";
      const std::string near = did_you_mean(key, known);
      hint += (hint.empty() || near.empty() ? "" : " ") + near;
    }
  if (!unknown.empty()) root.fail(unknown, hint);
}

}  // namespace tureen::trainer
