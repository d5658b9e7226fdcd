// Shared by the tests of the gradients of splats: a small image, its camera, noise as the
// derivatives of a loss, and comparisons of gradients.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "scene/camera.hpp"
#include "tests/support/random.hpp"
#include "tests/trainer/gaussian_reference.hpp"
#include "trainer/splats/parameter_kinds.hpp"

namespace tureen::trainer::test {

inline constexpr int width = 22, height = 19;  // no multiples of a tile
inline constexpr std::array<float, 3> background{0.2f, 0.5f, 0.9f};

inline Camera camera() {
  Camera result = look_at({0.3, -0.4, 4}, {0, 0, 0}, {0.1, 1, 0}, 0.7, width, height);
  result.fx *= 1.1;
  result.cx += 0.7;
  return result;
}

/// The trained values, splat after splat.
template <class Real, class Parameters>
std::vector<Real> values_of(const Parameters& parameters) {
  std::vector<Real> result;
  for (std::size_t i = 0; i < parameters.count(); ++i)
    for (std::size_t r = 0; r < parameters.rows(); ++r)
      result.emplace_back(double(parameters.trained(r)[i]));
  return result;
}

/// The derivatives of a loss by the image: noise.
inline std::vector<float> random_gradient(std::uint64_t seed) {
  tureen::test::Random random(seed);
  std::vector<float> result(3 * width * height);
  for (float& value : result) value = float(random.normal());
  return result;
}

/// sum(image . by_image).
template <class Real>
Real sum_of(const std::vector<Real>& image, const std::vector<float>& by_image) {
  Real sum = 0;
  for (std::size_t k = 0; k < image.size(); ++k) sum = sum + image[k] * Real(double(by_image[k]));
  return sum;
}

/// The derivative of `loss`(values) by each value.
template <class Loss>
std::vector<double> slopes_of(std::vector<Dual> values, const Loss& loss) {
  std::vector<double> result;
  for (Dual& variable : values) {
    variable.slope = 1;
    result.push_back(loss(values).slope);
    variable.slope = 0;
  }
  return result;
}

/// Each kind of parameter of each splat, relative to its length, and by `least` at most.
inline void expect_close(std::span<const ParameterKind> kinds, std::size_t rows,
                         const std::vector<float>& actual, const std::vector<double>& expected,
                         double tolerance, double least, std::uint64_t seed) {
  std::size_t moving = 0;
  for (std::size_t i = 0; i < expected.size() / rows; ++i)
    for (const ParameterKind& kind : kinds) {
      double difference = 0, length = 0;
      for (std::size_t r = kind.first; r < std::min(kind.first + kind.size, rows); ++r) {
        const double e = expected[i * rows + r];
        difference += std::pow(double(actual[i * rows + r]) - e, 2);
        length += e * e;
      }
      moving += length > 0;
      EXPECT_LE(std::sqrt(difference), tolerance * std::sqrt(length) + least)
          << kind.name << " of splat " << i << ", seed " << seed << ", length "
          << std::sqrt(length);
    }
  EXPECT_GT(moving, expected.size() / rows) << "too little to compare";
}

/// `gradient` is that of central differences of `loss`(values). Their error is of the order of
/// step^2, and rounding / step. No pixel may cross a limit of alpha within such a step.
template <class Real = double, class Loss>
void expect_differences(const std::vector<double>& start, const std::vector<double>& gradient,
                        std::size_t rows, const Loss& loss, Real step = 1e-6) {
  std::vector<Real> values(start.begin(), start.end());
  for (std::size_t k = 0; k < values.size(); ++k) {
    const Real middle = values[k];
    values[k] = middle + step;
    const Real above = loss(values);
    values[k] = middle - step;
    const Real below = loss(values);
    values[k] = middle;
    const auto difference = double((above - below) / (2 * step));
    EXPECT_NEAR(gradient[k], difference, 1e-6 * std::max(1.0, std::abs(difference)))
        << "row " << k % rows << " of splat " << k / rows;
  }
}

/// Compares derivatives at both sides of branches with one-sided differences. `Loss` is called with
/// values and with Branches to fill. `Real`: of the differences.
template <class Real, class Loss>
class BranchScan {
 public:
  /// `step`: of the differences. Their error is step^2 / 3 times the third derivative, and rounding
  /// / step.
  BranchScan(std::vector<double> start, double step, Loss loss)
      : start_(std::move(start)), step_(step), loss_(std::move(loss)) {}

  /// The letters that changed at some branch.
  const std::string& met() const { return met_; }

  /// Searches for branches of value `k` in intervals.
  void scan(std::size_t k, double low, double high, int intervals) {
    for (int i = 0; i < intervals; ++i)
      expect_both_sides(k, low + (high - low) * i / intervals,
                        low + (high - low) * (i + 1) / intervals);
  }

 private:
  template <class Value>
  Value at(std::size_t k, Value value) {
    std::vector<Value> values(start_.begin(), start_.end());
    values[k] = value;
    return loss_(values, branches_);
  }

  void expect_both_sides(std::size_t k, Real low, Real high) {
    at(k, low);
    const Branches before = branches_;
    at(k, high);
    if (branches_ == before) return;
    while (high - low > 1e-13 * std::max(Real(1), std::abs(low))) {
      const Real middle = (low + high) / 2;
      if (middle <= low || middle >= high) break;
      at(k, middle);
      (branches_ == before ? low : high) = middle;
    }
    at(k, high);
    for (std::size_t i = 0; i < std::min(before.size(), branches_.size()); ++i)
      if (before[i] != branches_[i]) {
        met_ += {before[i], branches_[i]};
        break;
      }
    for (const bool is_low : {true, false}) {
      const Real step = is_low ? -step_ : step_;
      // A step away, where numbers of less precision are on the same side.
      const auto from = double((is_low ? low : high) + step);
      at(k, is_low ? low : high);
      const Branches here = branches_;
      const Real value = at(k, Real(from)), next = at(k, from + step);
      const Real after = at(k, from + 2 * step);
      if (branches_ != here) continue;  // another branch is as near
      const auto difference = double((4 * next - 3 * value - after) / (2 * step));
      EXPECT_NEAR(at(k, Dual(from, 1)).slope, difference,
                  1e-6 * std::max(1.0, std::abs(difference)))
          << "value " << k << " at " << from;
    }
  }

  std::vector<double> start_;
  double step_;
  Loss loss_;
  Branches branches_;
  std::string met_;
};

template <class Real, class Loss>
BranchScan<Real, Loss> branch_scan(std::vector<double> start, double step, Loss loss) {
  return {std::move(start), step, std::move(loss)};
}

}  // namespace tureen::trainer::test
