// The rows of the tables of trained parameters, for splats of any kernel.
#pragma once

#include <cstddef>
#include <string_view>

namespace tureen::trainer {

/// A row of a table: the parameters `first` to `first` + `size` - 1.
struct ParameterKind {
  std::string_view name;
  std::size_t first, size;
  float rate, last_rate;  // of Adam, at the first and the last step; positions: times a length
};

/// The highest degree of harmonics that is trained.
inline constexpr int max_trained_degree = 3;

}  // namespace tureen::trainer
