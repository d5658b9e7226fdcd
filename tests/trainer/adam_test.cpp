#include "trainer/common/kernels/adam.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <vector>

#include "tests/support/random.hpp"

namespace tureen::trainer {
namespace adam_test {

using tureen::test::Random;

constexpr float beta1 = 0.9f, beta2 = 0.999f, epsilon = 1e-8f;

kernels::AdamStep step_at(double t, float rate = 1e-2f) {
  return kernels::adam_step(rate, beta1, beta2, epsilon, t);
}

// Algorithm 1 of the paper in double, for a vector with one shared second moment (VectorAdam) or
// for a single number (Adam).
template <std::size_t Size>
struct Reference {
  std::array<double, Size> value{}, first{};
  double second = 0;

  void step(double rate, const std::array<double, Size>& gradient, double t) {
    double squared = 0;
    for (const double g : gradient) squared += g * g;
    second = double(beta2) * second + (1 - double(beta2)) * squared;
    const double root = std::sqrt(second / (1 - std::pow(double(beta2), t)));
    for (std::size_t i = 0; i < Size; ++i) {
      first[i] = double(beta1) * first[i] + (1 - double(beta1)) * gradient[i];
      const double mean = first[i] / (1 - std::pow(double(beta1), t));
      value[i] -= rate * mean / (root + double(epsilon));
    }
  }
};

TEST(Adam, FollowsThePaperInDouble) {
  Random random(1);
  // Gradients in training have about the size of epsilon: one view's share of a million pixels.
  for (const double scale : {1.0, 1e-4, 1e-8}) {
    Reference<1> reference;
    float value = 0, first = 0, second = 0;
    for (int t = 1; t <= 1000; ++t) {
      const auto gradient = float(scale * (random.normal() + 0.3));
      kernels::adam(step_at(t), gradient, value, first, second);
      reference.step(double(1e-2f), {gradient}, t);
      // A step is at most about the rate. Its relative error and the sum's rounding are below 1e-6
      // each, with random signs: 1e-2 sqrt(1000) 1e-6, with a margin of ten. The value reaches 10,
      // where one rounding is 5e-7.
      ASSERT_NEAR(value, reference.value[0], 2e-5) << "scale " << scale << ", step " << t;
    }
    EXPECT_NEAR(first, reference.first[0], 1e-5 * scale);
    EXPECT_NEAR(second, reference.second, 1e-5 * scale * scale);
  }
}

TEST(Adam, TheFirstStepIsTheRateWhateverTheGradient) {
  for (const float gradient : {1e-4f, -1.0f, 1e6f, -1e18f}) {
    float value = 0, first = 0, second = 0;
    kernels::adam(step_at(1), gradient, value, first, second);
    // epsilon reduces the smallest by 1e-4; 1 - 0.999f has a relative error of 6e-8 / 1e-3.
    EXPECT_NEAR(value, -std::copysign(1e-2f, gradient), 1e-2f * 2e-4f) << gradient;
  }
}

TEST(Adam, RestartedMomentsKick) {
  // docs/numerics.md, O1: the mean step in rates after a reset, for gradients that are noise.
  // Exactly 1 at first; from t = 2 on the published measurements, to their last digit.
  Random random(2);
  constexpr int trials = 1000;
  std::vector<double> mean(1001);
  for (int trial = 0; trial < trials; ++trial) {
    float value = 0, first = 0, second = 0;
    for (int t = 1; t <= 1000; ++t) {
      const float before = value;
      kernels::adam(step_at(t, 1.0f), float(random.normal()), value, first, second);
      mean[std::size_t(t)] += std::abs(value - before) / (trials);
    }
  }
  double steady = 0;
  for (int t = 901; t <= 1000; ++t) steady += mean[std::size_t(t)] / 100;
  // The deviation of one |step| is at most 0.4, of the mean of 1000 then 0.013; the bound is four
  // of those.
  EXPECT_NEAR(mean[1], 1.00, 1e-3);
  EXPECT_NEAR(mean[2], 0.64, 0.05);
  EXPECT_NEAR(mean[10], 0.27, 0.05);
  EXPECT_NEAR(mean[100], 0.18, 0.05);
  // sqrt(2 / pi (1 - beta1) / (1 + beta1)) = 0.183; the mean of 100 steps, correlated over 10.
  EXPECT_NEAR(steady, 0.183, 0.01);
}

TEST(Adam, NothingMovesWithoutGradientAndLittleWithDenormals) {
  float value = 1.5f, first = 0, second = 0;
  kernels::adam(step_at(1), 0.0f, value, first, second);
  EXPECT_EQ(value, 1.5f);
  // The square underflows below the normal floats. Without epsilon the step would be the full rate
  // or a division by zero; with it, the step is rate g / epsilon.
  for (const float gradient : {1e-20f, 1e-30f, std::numeric_limits<float>::denorm_min()}) {
    float moved = 0;
    first = second = 0;
    kernels::adam(step_at(1), gradient, moved, first, second);
    EXPECT_LE(std::abs(moved), 1e-2f * gradient / epsilon * 1.001f) << gradient;
    float vector[3] = {}, vector_first[3] = {};
    second = 0;
    kernels::vector_adam(step_at(1), {gradient, 0, 0}, vector, vector_first, second);
    EXPECT_LE(std::abs(vector[0]), 1e-2f * gradient / epsilon * 1.001f) << gradient;
  }
}

TEST(VectorAdam, FollowsTheDefinitionInDouble) {
  Random random(3);
  Reference<3> reference;
  float value[3] = {}, first[3] = {}, second = 0;
  for (int t = 1; t <= 1000; ++t) {
    float gradient[3];
    for (float& g : gradient) g = float(random.normal() + 0.2);
    kernels::vector_adam(step_at(t), gradient, value, first, second);
    reference.step(double(1e-2f), {gradient[0], gradient[1], gradient[2]}, t);
    for (std::size_t i = 0; i < 3; ++i)
      ASSERT_NEAR(value[i], reference.value[i], 1e-5) << t;  // as for Adam
  }
}

TEST(VectorAdam, TurnsWithTheAxes) {
  // docs/numerics.md, O4: the trajectory of a rotated problem is the rotated trajectory.
  const glm::dmat3 turn(
      glm::rotate(glm::dmat4(1.0), glm::radians(37.0), glm::normalize(glm::dvec3(1, 2, -3))));
  Random random(4);
  float value[3] = {}, first[3] = {}, second = 0;
  float turned_value[3] = {}, turned_first[3] = {}, turned_second = 0;
  for (int t = 1; t <= 200; ++t) {
    const glm::dvec3 g(random.normal() + 1, random.normal(), 0.01 * random.normal());
    const glm::dvec3 h = turn * g;
    kernels::vector_adam(step_at(t), {float(g.x), float(g.y), float(g.z)}, value, first, second);
    kernels::vector_adam(step_at(t), {float(h.x), float(h.y), float(h.z)}, turned_value,
                         turned_first, turned_second);
    const glm::dvec3 expected = turn * glm::dvec3(value[0], value[1], value[2]);
    for (int i = 0; i < 3; ++i) ASSERT_NEAR(turned_value[i], expected[i], 1e-5) << t;
  }
}

}  // namespace adam_test
}  // namespace tureen::trainer
