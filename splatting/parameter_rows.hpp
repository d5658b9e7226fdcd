// Numbers of splats as rows of floats, which vectors read: row r holds parameter r of every splat.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tureen::splatting {

/// Rows start at multiples of this many floats: a vector never reads beyond its row.
inline constexpr std::size_t row_alignment = 16;

class ParameterRows {
 public:
  ParameterRows() = default;
  /// Zeros.
  ParameterRows(std::size_t rows, std::size_t count)
      : rows_(rows), count_(count), lines_a_row_((count + row_alignment - 1) / row_alignment) {
    lines_.resize(rows * lines_a_row_);
  }

  std::size_t count() const { return count_; }
  std::size_t rows() const { return rows_; }
  /// From one row to the next.
  std::size_t stride() const { return lines_a_row_ * row_alignment; }
  /// count() values; stride() of them can be read and written.
  float* row(std::size_t i) { return lines_[i * lines_a_row_].values; }
  const float* row(std::size_t i) const { return lines_[i * lines_a_row_].values; }

  /// All rows one after the other, stride() floats each.
  std::span<float> values() {
    return {lines_.empty() ? nullptr : lines_.front().values, lines_.size() * row_alignment};
  }
  std::span<const float> values() const {
    return {lines_.empty() ? nullptr : lines_.front().values, lines_.size() * row_alignment};
  }

 private:
  struct alignas(row_alignment * sizeof(float)) Line {
    float values[row_alignment];
  };
  std::size_t rows_ = 0, count_ = 0, lines_a_row_ = 0;
  std::vector<Line> lines_;
};

}  // namespace tureen::splatting
