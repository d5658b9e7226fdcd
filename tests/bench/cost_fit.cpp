#include "bench/cost_fit.hpp"

#include <cmath>
#include <glm/glm.hpp>

namespace tureen::test {

namespace {

constexpr int unknowns = 4;

glm::dvec4 factors(const CostSample& sample) {
  return {1, sample.triangles, sample.fragments, sample.shaded_pixels};
}

/// Of columns of unit length a diagonal element of the inverse normal matrix says how many times
/// the others inflate the variance of this one; beyond this, of 16 digits six are left.
constexpr double most_inflation = 1e10;

}  // namespace

double CostFit::predict(const CostSample& sample) const {
  return glm::dot(glm::dvec4(ms[0], ms[1], ms[2], ms[3]), factors(sample));
}

std::optional<CostFit> fit_costs(std::span<const CostSample> samples) {
  if (samples.size() <= std::size_t(unknowns)) return {};
  // Rows divided by the time that was measured, columns by their length: times are then all 1, and
  // costs that differ by 10^9 do not lose each other's digits.
  std::vector<glm::dvec4> rows;
  glm::dvec4 squared(0.0);
  for (const CostSample& sample : samples) {
    rows.push_back(factors(sample) / sample.ms);
    squared += rows.back() * rows.back();
  }
  const glm::dvec4 length = glm::sqrt(squared);
  if (glm::any(glm::lessThanEqual(length, glm::dvec4(0.0)))) return {};
  glm::dmat4 normal(0.0);
  glm::dvec4 right(0.0);
  for (glm::dvec4 row : rows) {
    row /= length;
    right += row;
    normal += glm::outerProduct(row, row);
  }
  const glm::dmat4 covariance = glm::inverse(normal);
  for (int i = 0; i < unknowns; ++i)
    if (!(covariance[i][i] > 0 && covariance[i][i] < most_inflation)) return {};
  const glm::dvec4 ms = covariance * right / length;
  CostFit fit;
  for (int i = 0; i < unknowns; ++i) fit.ms[std::size_t(i)] = ms[i];
  double squares = 0;
  for (const CostSample& sample : samples) {
    fit.residuals.push_back(fit.predict(sample) / sample.ms - 1);
    squares += fit.residuals.back() * fit.residuals.back();
  }
  const double variance = squares / double(samples.size() - std::size_t(unknowns));
  for (int i = 0; i < unknowns; ++i)
    fit.standard_error[std::size_t(i)] = std::sqrt(variance * covariance[i][i]) / length[i];
  return fit;
}

}  // namespace tureen::test
