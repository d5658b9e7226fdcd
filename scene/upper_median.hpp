// The middle of numbers.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace tureen {

/// The middle value; the larger of the two if their number is even. Needs a value; none is NaN.
inline double upper_median(std::vector<double> values) {
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace tureen
