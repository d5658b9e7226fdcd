// The emulated network against what was measured before this was written, on networks of
// the same law.
#include "soup/mlp_precision.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

namespace tureen {
namespace {

constexpr unsigned seed = 5;

/// Weights uniform with the bounds of Kaiming (hidden) and Xavier (last), biases a tenth of normal,
/// all times the gain; blended by channel 3.
ColorMlp random_mlp(std::mt19937& random, double gain) {
  std::normal_distribution<double> normal;
  ColorMlp mlp;
  for (const auto& [outputs, bound] :
       {std::pair{16, std::sqrt(6.0 / 16)}, {16, std::sqrt(6.0 / 16)}, {3, std::sqrt(6.0 / 19)}}) {
    std::uniform_real_distribution<double> uniform(-bound, bound);
    DenseLayer layer{16, outputs, {}, {}};
    for (int i = 0; i < 16 * outputs; ++i) layer.weights.push_back(float(gain * uniform(random)));
    for (int i = 0; i < outputs; ++i) layer.biases.push_back(float(0.1 * gain * normal(random)));
    mlp.layers.push_back(std::move(layer));
  }
  mlp.encoding = DirectionEncoding::harmonics2;
  mlp.blend_channel = 3;
  return mlp;
}

/// PSNR against the exact network, over random networks, features and directions.
double measured_psnr(MlpPrecision precision, double gain) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  double squared = 0;
  long count = 0;
  for (int network = 0; network < 40; ++network) {
    const ColorMlp mlp = random_mlp(random, gain);
    const EmulatedMlp emulated(mlp, precision);
    for (int i = 0; i < 250; ++i) {
      double features[7];
      for (double& f : features) f = 1 / (1 + std::exp(-2 * normal(random)));
      const glm::dvec3 d =
          glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
      const glm::dvec3 e = emulated(features, d) - evaluate(mlp, features, d);
      squared += glm::dot(e, e);
      count += 3;
    }
  }
  return -10 * std::log10(squared / double(count));
}

struct Anchor {
  MlpPrecision precision;
  double psnr_db[3];  // at gains 1, 2, 4
};

TEST(MlpPrecision, IsAsFarOffAsMeasured) {
  SCOPED_TRACE("seed " + std::to_string(seed));
  const Anchor anchors[] = {{MlpPrecision::half_weights, {89.3, 77.0, 69.4}},
                            {MlpPrecision::half, {82.5, 71.3, 63.5}},
                            {MlpPrecision::int8_weights, {66.9, 54.8, 46.0}}};
  const double gains[] = {1, 2, 4};
  for (const Anchor& anchor : anchors)
    for (int g = 0; g < 3; ++g) {
      const double psnr = measured_psnr(anchor.precision, gains[g]);
      RecordProperty(
          std::string(name_of(anchor.precision)) + "_gain_" + std::to_string(int(gains[g])),
          std::to_string(psnr));
      // Other networks of the same law, forty as there: their spread is about 1 dB, and the
      // features there are means of three, a little less spread.
      EXPECT_NEAR(psnr, anchor.psnr_db[g], 2.5) << name_of(anchor.precision) << " " << gains[g];
    }
}

TEST(MlpPrecision, FewerBitsAreFurtherOff) {
  SCOPED_TRACE("seed " + std::to_string(seed));
  const double float32 = measured_psnr(MlpPrecision::float32, 2);
  const double half = measured_psnr(MlpPrecision::half, 2);
  const double weights = measured_psnr(MlpPrecision::int8_weights, 2);
  const double int8 = measured_psnr(MlpPrecision::int8, 2);
  EXPECT_GT(float32, 120);  // 2^-24 of the values is 144 dB; sums of 16 lose a few bits
  EXPECT_GT(half, weights);
  EXPECT_GT(weights, int8);
  EXPECT_GT(int8, 40);
}

TEST(MlpPrecision, ExactIsEvaluate) {
  std::mt19937 random(seed);
  const ColorMlp mlp = random_mlp(random, 1);
  const double features[7] = {0.1, 0.9, 0.4, 0.7, 0.2, 0.3, 0.8};
  EXPECT_EQ(EmulatedMlp(mlp, MlpPrecision::exact)(features, {0, 0.6, 0.8}),
            evaluate(mlp, features, {0, 0.6, 0.8}));
}

}  // namespace
}  // namespace tureen
