#include "bench/cost_fit.hpp"

#include <algorithm>
#include <cmath>

namespace tureen::test {

namespace {

constexpr std::size_t unknowns = 4;
using Vector = std::array<double, unknowns>;
using Matrix = std::array<Vector, unknowns>;

Vector factors(const CostSample& sample) {
  return {1, sample.triangles, sample.fragments, sample.shaded_pixels};
}

/// Gauss and Jordan with pivots; nothing where a pivot is lost to rounding.
std::optional<Matrix> inverse(Matrix matrix) {
  Matrix result{};
  for (std::size_t i = 0; i < unknowns; ++i) result[i][i] = 1;
  for (std::size_t column = 0; column < unknowns; ++column) {
    std::size_t pivot = column;
    for (std::size_t row = column; row < unknowns; ++row)
      if (std::abs(matrix[row][column]) > std::abs(matrix[pivot][column])) pivot = row;
    // Columns were scaled to unit length: what is left below this is rounding.
    if (!(std::abs(matrix[pivot][column]) > 1e-10)) return {};
    std::swap(matrix[pivot], matrix[column]);
    std::swap(result[pivot], result[column]);
    const double scale = 1 / matrix[column][column];
    for (std::size_t k = 0; k < unknowns; ++k) {
      matrix[column][k] *= scale;
      result[column][k] *= scale;
    }
    for (std::size_t row = 0; row < unknowns; ++row) {
      if (row == column) continue;
      const double factor = matrix[row][column];
      for (std::size_t k = 0; k < unknowns; ++k) {
        matrix[row][k] -= factor * matrix[column][k];
        result[row][k] -= factor * result[column][k];
      }
    }
  }
  return result;
}

}  // namespace

double CostFit::predict(const CostSample& sample) const {
  const Vector x = factors(sample);
  double sum = 0;
  for (std::size_t i = 0; i < unknowns; ++i) sum += ms[i] * x[i];
  return sum;
}

std::optional<CostFit> fit_costs(std::span<const CostSample> samples) {
  if (samples.size() <= unknowns) return {};
  // Rows divided by the time that was measured, columns by their length: times are then all 1, and
  // costs that differ by 10^9 do not lose each other's digits.
  std::vector<Vector> rows;
  Vector length{};
  for (const CostSample& sample : samples) {
    Vector& row = rows.emplace_back(factors(sample));
    for (std::size_t i = 0; i < unknowns; ++i) {
      row[i] /= sample.ms;
      length[i] += row[i] * row[i];
    }
  }
  for (double& value : length) value = std::sqrt(value);
  if (*std::min_element(length.begin(), length.end()) <= 0) return {};
  Matrix normal{};
  Vector right{};
  for (Vector& row : rows) {
    for (std::size_t i = 0; i < unknowns; ++i) row[i] /= length[i];
    for (std::size_t i = 0; i < unknowns; ++i) {
      right[i] += row[i];
      for (std::size_t j = 0; j < unknowns; ++j) normal[i][j] += row[i] * row[j];
    }
  }
  const std::optional<Matrix> covariance = inverse(normal);
  if (!covariance) return {};
  CostFit fit;
  for (std::size_t i = 0; i < unknowns; ++i) {
    for (std::size_t j = 0; j < unknowns; ++j) fit.ms[i] += (*covariance)[i][j] * right[j];
    fit.ms[i] /= length[i];
  }
  double squares = 0;
  for (const CostSample& sample : samples) {
    fit.residuals.push_back(fit.predict(sample) / sample.ms - 1);
    squares += fit.residuals.back() * fit.residuals.back();
  }
  const double variance = squares / double(samples.size() - unknowns);
  for (std::size_t i = 0; i < unknowns; ++i)
    fit.standard_error[i] = std::sqrt(std::max(0.0, variance * (*covariance)[i][i])) / length[i];
  return fit;
}

}  // namespace tureen::test
