// The functions of vectors against those of double precision, with their stated bounds.
#include <gtest/gtest.h>

#include <cmath>

#include "splatting/vector_math-inl.hpp"
#include "tests/support/random.hpp"

namespace tureen::test {
namespace vector_math_test {

namespace vectors = splatting::HWY_NAMESPACE;

template <class Function>
double value_of(Function function, float x) {
  return double(hwy::HWY_NAMESPACE::GetLane(function(vectors::constant(x))));
}

TEST(VectorMath, SinesHaveTheStatedErrors) {
  Random random(1);
  for (int i = 0; i < 300'000; ++i) {
    const float x = float((i % 2 ? 1 : -1) * std::exp(random.uniform(-20, std::log(1e5))));
    const double bound = 2e-7 + 6e-8 * std::abs(double(x));
    ASSERT_NEAR(value_of(vectors::sin_of, x), std::sin(double(x)), bound) << x;
    ASSERT_NEAR(value_of(vectors::cos_of, x), std::cos(double(x)), bound) << x;
    ASSERT_NEAR(value_of(vectors::sinc_of, x), std::sin(double(x)) / double(x), 2e-7) << x;
    if (std::abs(x) < 1.5f) {
      ASSERT_NEAR(value_of(vectors::sin_of, x) / std::sin(double(x)), 1, 2e-7) << x;
    }
  }
  for (const float x : {0.0f, -0.0f, 1e-45f}) EXPECT_EQ(value_of(vectors::sinc_of, x), 1) << x;
}

TEST(VectorMath, OneMinusExpHasTheStatedError) {
  Random random(2);
  for (int i = 0; i < 300'000; ++i) {
    const float x = float(std::exp(random.uniform(-60, 6)));
    ASSERT_NEAR(value_of(vectors::one_minus_exp_of, x) / -std::expm1(-double(x)), 1, 5e-6) << x;
  }
  EXPECT_EQ(value_of(vectors::one_minus_exp_of, 0.0f), 0);
  EXPECT_EQ(value_of(vectors::one_minus_exp_of, INFINITY), 1);
}

}  // namespace vector_math_test
}  // namespace tureen::test
