#include "trainer/common/range.hpp"

#include <fmt/format.h>

#include <cmath>

#include "base/decimal.hpp"

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

}  // namespace tureen::trainer
