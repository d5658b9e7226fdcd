// The rows of the tables of trained parameters, for splats of any kernel.
#pragma once

#include <cstddef>
#include <string_view>

namespace tureen::trainer {

/// The drawn value, as a function of the trained one.
enum class Activation {
  identity,
  exponential,
  floored_exponential,  // 0.01 + exp(value)
  unit_length,
  sigmoid
};

/// The values of the children of a split. A relocated splat is the second child of another one.
enum class Inheritance {
  copied,
  moved_apart,
  shortened,
  halved  // the parts of a triangle
};

/// A row of a table: the parameters `first` to `first` + `size` - 1.
struct ParameterKind {
  std::string_view name;
  std::size_t first, size;
  Activation activation;
  float rate, last_rate;  // of Adam, at the first and the last step; positions: times a length
  Inheritance inheritance;
};

/// The highest degree of harmonics that is trained.
inline constexpr int max_trained_degree = 3;

}  // namespace tureen::trainer
