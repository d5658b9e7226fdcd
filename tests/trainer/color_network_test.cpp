#include "trainer/diffsoup/kernels/color_network.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "scene/spherical_harmonics.hpp"
#include "tests/support/random.hpp"
#include "trainer/common/kernels/pack.hpp"
#include "trainer/common/kernels/scalar.hpp"
#include "trainer/diffsoup/mlp_parameters.hpp"

namespace tureen::trainer {
namespace color_network_test {

using tureen::test::Random;
using Parameters = std::array<double, mlp_parameters>;
using Inputs = std::array<double, mlp_inputs>;

// Weights as at the start of training, plus biases, which are 0 there.
MlpParameters random_network(Random& random) {
  MlpParameters mlp = initial_mlp(random.below(1u << 30));
  for (float& number : mlp) number += float(0.1 * random.normal());
  return mlp;
}

Inputs random_inputs(Random& random, glm::dvec3& to_eye) {
  Inputs inputs;
  for (int f = 0; f < kernels::features; ++f) inputs[std::size_t(f)] = random.uniform();
  to_eye = random.direction();
  const auto basis = harmonics::basis(to_eye);
  std::copy_n(basis.begin(), 9, inputs.begin() + kernels::features);
  return inputs;
}

// dcolor . colour, the scalar whose gradient shade_backward returns.
double weighted_color(const Parameters& mlp, const Inputs& inputs, const double (&dcolor)[3]) {
  kernels::NetworkState<double> state;
  std::copy(inputs.begin(), inputs.end(), state.input);
  double color[3];
  kernels::shade(mlp.data(), state, color);
  return dcolor[0] * color[0] + dcolor[1] * color[1] + dcolor[2] * color[2];
}

Parameters in_double(const MlpParameters& mlp) {
  Parameters result;
  std::copy(mlp.begin(), mlp.end(), result.begin());
  return result;
}

TEST(ColorNetwork, ShadesLikeTheNetworkOfTheScene) {
  Random random(1);
  for (int trial = 0; trial < 200; ++trial) {
    const MlpParameters parameters = random_network(random);
    const Parameters mlp = in_double(parameters);
    const ColorMlp scene = color_mlp(parameters);
    glm::dvec3 to_eye;
    const Inputs inputs = random_inputs(random, to_eye);
    kernels::NetworkState<double> state;
    std::copy(inputs.begin(), inputs.end(), state.input);
    double color[3];
    kernels::shade(mlp.data(), state, color);
    const glm::dvec3 expected = evaluate(scene, std::span(inputs).first(7), to_eye);
    for (int c = 0; c < 3; ++c) ASSERT_NEAR(color[c], expected[c], 1e-12) << "trial " << trial;
  }
}

TEST(ColorNetwork, HarmonicsAreThoseOfTheScene) {
  Random random(2);
  for (int trial = 0; trial < 1000; ++trial) {
    const glm::dvec3 d = random.direction();
    double basis[9];
    kernels::harmonics9(d.x, d.y, d.z, basis);
    const auto expected = harmonics::basis(d);
    // The kernel's constants are floats, at most 1.1: half a unit in the last place is 6e-8.
    for (int i = 0; i < 9; ++i) ASSERT_NEAR(basis[i], expected[std::size_t(i)], 2e-7) << i;
  }
}

TEST(ColorNetwork, GradientsAreFiniteDifferences) {
  Random random(3);
  double largest = 0;  // relative error
  for (int trial = 0; trial < 20; ++trial) {
    const Parameters mlp = in_double(random_network(random));
    glm::dvec3 to_eye;
    const Inputs inputs = random_inputs(random, to_eye);
    const double dcolor[3] = {random.normal(), random.normal(), random.normal()};
    kernels::NetworkState<double> state;
    std::copy(inputs.begin(), inputs.end(), state.input);
    double color[3], dfeatures[kernels::features];
    kernels::shade(mlp.data(), state, color);
    Parameters dmlp{};
    kernels::shade_backward(mlp.data(), state, dcolor, dmlp.data(), dfeatures);
    // Differences of fourth order: h^4 = 1e-16 and rounding 1e-16 / h = 1e-12. This resolves 1e-6
    // of a gradient down to gradients of 1e-6. No ReLU's kink may lie within 2e-4; this seed has
    // none.
    constexpr double h = 1e-4;
    const auto check = [&](double gradient, auto&& at, const std::string& what) {
      const double difference = (8 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12 * h);
      const double error = std::abs(gradient - difference) / (std::abs(difference) + 1e-5);
      largest = std::max(largest, error);
      EXPECT_LT(error, 1e-6) << "trial " << trial << ", " << what;
    };
    for (std::size_t i = 0; i < mlp_parameters; ++i)
      check(
          dmlp[i],
          [&](double d) {
            Parameters moved = mlp;
            moved[i] += d;
            return weighted_color(moved, inputs, dcolor);
          },
          "parameter " + std::to_string(i));
    for (std::size_t f = 0; f < kernels::features; ++f)
      check(
          dfeatures[f],
          [&](double d) {
            Inputs moved = inputs;
            moved[f] += d;
            return weighted_color(mlp, moved, dcolor);
          },
          "feature " + std::to_string(f));
  }
  RecordProperty("largest_relative_error_1e_9", std::to_string(1e9 * largest));
}

#if defined(__GNUC__)

using kernels::Pack;
constexpr int lanes = kernels::pack_lanes;

TEST(ColorNetwork, LanesOfAPackAreFloatsSideBySide) {
  Random random(4);
  const MlpParameters mlp = random_network(random);
  kernels::NetworkState<Pack> pack;
  kernels::NetworkState<float> single[lanes];
  Pack dcolor[3];
  float single_dcolor[lanes][3];
  for (int l = 0; l < lanes; ++l) {
    glm::dvec3 to_eye;
    const Inputs inputs = random_inputs(random, to_eye);
    for (int i = 0; i < mlp_inputs; ++i)
      pack.input[i][l] = single[l].input[i] = float(inputs[std::size_t(i)]);
    for (int c = 0; c < 3; ++c) dcolor[c][l] = single_dcolor[l][c] = float(random.normal());
  }
  Pack color[3], dfeatures[kernels::features], dmlp[mlp_parameters] = {};
  kernels::shade(mlp.data(), pack, color);
  kernels::shade_backward(mlp.data(), pack, dcolor, dmlp, dfeatures);
  for (int l = 0; l < lanes; ++l) {
    float single_color[3], single_dfeatures[kernels::features], single_dmlp[mlp_parameters] = {};
    kernels::shade(mlp.data(), single[l], single_color);
    kernels::shade_backward(mlp.data(), single[l], single_dcolor[l], single_dmlp, single_dfeatures);
    // The same operations in the same order. If a compiler fuses multiplications with additions in
    // only one of them, the last bit of a sum of sixteen differs.
    const auto same = [&](float a, float b, const char* what, int i) {
      EXPECT_NEAR(a, b, 1e-6 * (1 + std::abs(b))) << "lane " << l << ", " << what << " " << i;
    };
    for (int c = 0; c < 3; ++c) same(color[c][l], single_color[c], "color", c);
    for (int f = 0; f < kernels::features; ++f)
      same(dfeatures[f][l], single_dfeatures[f], "feature", f);
    for (int i = 0; i < mlp_parameters; ++i) same(dmlp[i][l], single_dmlp[i], "parameter", i);
  }
}

TEST(Scalar, LanesOfAnExponentialAreFloatsSideBySide) {
  Random random(5);
  for (int trial = 0; trial < 1000; ++trial) {
    Pack x;
    for (int l = 0; l < lanes; ++l) x[l] = float(random.uniform(-100, 100));
    const Pack y = kernels::exponential(x), s = kernels::sigmoid(x), p = kernels::positive_part(x);
    for (int l = 0; l < lanes; ++l) {
      // Two units in the last place, for compilers that fuse in only one of them.
      ASSERT_NEAR(y[l], kernels::exponential(x[l]), 3e-7 * kernels::exponential(x[l])) << x[l];
      ASSERT_NEAR(s[l], kernels::sigmoid(x[l]), 3e-7) << x[l];
      ASSERT_EQ(p[l], std::max(x[l], 0.0f));
    }
  }
}

#endif

// |computed - e^x| in units in the last place of a float with that exponent.
double error_in_ulp(float computed, double x) {
  const double exact = std::exp(x);
  const auto rounded = float(exact);
  const double ulp =
      double(std::nextafter(rounded, std::numeric_limits<float>::infinity())) - double(rounded);
  return std::abs(double(computed) - exact) / ulp;
}

TEST(Scalar, TheExponentialIsExactToTwoUnitsInTheLastPlace) {
  double largest = 0;
  float worst = 0;
  for (int i = -870'000; i <= 870'000; ++i) {
    const auto x = float(i * 1e-4);
    const double error = error_in_ulp(kernels::exponential(x), double(x));
    if (error > largest) largest = error, worst = x;
  }
  EXPECT_LE(largest, 2.0) << "at " << worst;
  RecordProperty("largest_error_ulp", std::to_string(largest));
  EXPECT_EQ(kernels::exponential(0.0f), 1.0f);
}

TEST(Scalar, BeyondItsRangeTheExponentialStaysFinite) {
  const float infinity = std::numeric_limits<float>::infinity();
  for (const float x : {88.0f, 1e10f, infinity})
    EXPECT_EQ(kernels::exponential(x), kernels::exponential(87.0f));
  for (const float x : {-88.0f, -1e10f, -infinity})
    EXPECT_EQ(kernels::exponential(x), kernels::exponential(-87.0f));
  EXPECT_TRUE(std::isfinite(kernels::exponential(87.0f)));
  EXPECT_GE(kernels::exponential(-87.0f), std::numeric_limits<float>::min());
  EXPECT_TRUE(std::isnan(kernels::exponential(std::numeric_limits<float>::quiet_NaN())));
}

TEST(Scalar, HalvesAreTheNearestOnes) {
  Random random(6);
  for (int trial = 0; trial < 200'000; ++trial) {
    const auto x = float(std::ldexp(random.uniform(-1, 1), int(random.below(31)) - 14));
    const float half = kernels::rounded_to_half(x);
    if (std::abs(x) < 0x1p-14f) {
      ASSERT_EQ(half, 0.0f) << x;
      continue;
    }
    if (std::abs(x) > 65504.0f) {
      ASSERT_EQ(half, std::copysign(65504.0f, x)) << x;
      continue;
    }
    // 11 significant bits.
    int exponent = 0;
    std::frexp(x, &exponent);
    const double unit = std::ldexp(1.0, exponent - 11);
    ASSERT_EQ(std::fmod(double(half), unit), 0.0) << x;
    ASSERT_LE(std::abs(double(half) - double(x)), unit / 2) << x;
  }
  EXPECT_TRUE(std::isnan(kernels::rounded_to_half(NAN)));
  EXPECT_EQ(kernels::rounded_to_half(INFINITY), 65504.0f);
}

TEST(Scalar, TheSigmoidSaturatesWithoutNaN) {
  EXPECT_EQ(kernels::sigmoid(0.0f), 0.5f);
  EXPECT_EQ(kernels::sigmoid(1e30f), 1.0f);
  EXPECT_EQ(kernels::sigmoid(20.0f), 1.0f);
  EXPECT_GE(kernels::sigmoid(-1e30f), 0.0f);
  EXPECT_LT(kernels::sigmoid(-1e30f), 1e-37f);
  for (float x = -30; x <= 30; x += 0.01f) {
    const double exact = 1 / (1 + std::exp(-double(x)));
    // Two units of the exponential, one of the sum, one of the quotient.
    ASSERT_NEAR(kernels::sigmoid(x), exact, 3e-7 * exact) << x;
  }
}

}  // namespace color_network_test
}  // namespace tureen::trainer
