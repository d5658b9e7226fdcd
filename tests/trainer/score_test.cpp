// The score function of opacity: exactly, by enumeration of all outcomes, and on average, through
// the stages of a step.
#include "trainer/common/kernels/score.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "scene/triangle_soup.hpp"
#include "tests/support/random.hpp"
#include "tests/trainer/fragments.hpp"
#include "tests/trainer/stages.hpp"
#include "trainer/common/kernels/random.hpp"

namespace tureen::trainer {
namespace score_test {

using kernels::FragmentRole;
using kernels::logit_score;
using tureen::test::Random;

// One fragment. Its alpha is the weighted mean of three texels' alphas; the weights sum to 1.
struct Layer {
  std::array<double, 3> texels{}, weights{};
  double loss = 0;  // of the pixel, if this fragment shows

  double alpha() const {
    return weights[0] * texels[0] + weights[1] * texels[1] + weights[2] * texels[2];
  }
};

struct Stack {
  std::vector<Layer> layers;  // nearest first
  double background_loss = 0;

  double loss(std::size_t winner) const {
    return winner < layers.size() ? layers[winner].loss : background_loss;
  }
  /// The probability that this fragment shows; layers.size() is the background.
  double probability(std::size_t winner) const {
    double p = winner < layers.size() ? layers[winner].alpha() : 1;
    for (std::size_t i = 0; i < winner; ++i) p *= 1 - layers[i].alpha();
    return p;
  }
  /// dE[loss]/dlogit of a texel: alpha's derivative times T (l_k - E[l | k rejected]), where T is
  /// the probability of reaching k. E is linear in each alpha (DiffSoup, arXiv 2603.27151).
  double derivative(std::size_t k, std::size_t texel) const {
    double reached = 1;
    for (std::size_t i = 0; i < k; ++i) reached *= 1 - layers[i].alpha();
    double behind = background_loss;
    for (std::size_t i = layers.size(); i-- > k + 1;)
      behind = layers[i].alpha() * layers[i].loss + (1 - layers[i].alpha()) * behind;
    const double a = layers[k].texels[texel];
    return layers[k].weights[texel] * a * (1 - a) * reached * (layers[k].loss - behind);
  }
  /// The score of a texel of layer k if `winner` shows.
  double score(std::size_t winner, std::size_t k, std::size_t texel) const {
    if (k > winner) return 0;
    const Layer& layer = layers[k];
    return logit_score(k == winner ? FragmentRole::winner : FragmentRole::in_front, layer.alpha(),
                       layer.weights[texel], layer.texels[texel]);
  }
  struct Mean {
    double mean = 0, variance = 0;
  };
  /// Mean and variance of (loss - baseline) * score over all outcomes.
  Mean enumerate(std::size_t k, std::size_t texel, double baseline) const {
    Mean result;
    for (std::size_t winner = 0; winner <= layers.size(); ++winner) {
      const double x = (loss(winner) - baseline) * score(winner, k, texel);
      result.mean += probability(winner) * x;
      result.variance += probability(winner) * x * x;
    }
    result.variance -= result.mean * result.mean;
    return result;
  }
};

constexpr std::array<double, 7> alphas = {0, 1e-7, 0.1, 0.5, 0.9, 1 - 1e-7, 1};

Stack random_stack(Random& random, std::size_t size) {
  Stack stack;
  stack.background_loss = random.uniform(0, 3);
  for (std::size_t i = 0; i < size; ++i) {
    Layer layer;
    const double a = random.uniform(), b = random.uniform() * (1 - a);
    layer.weights = {a, b, 1 - a - b};
    if (random.chance(0.3)) layer.weights = {1, 0, 0};
    for (double& texel : layer.texels) texel = alphas[random.below(alphas.size())];
    layer.loss = random.uniform(0, 3);
    stack.layers.push_back(layer);
  }
  return stack;
}

TEST(Score, ItsExpectationIsTheDerivative) {
  Random random(1);
  for (int trial = 0; trial < 2000; ++trial) {
    const Stack stack = random_stack(random, 1 + random.below(5));
    const double baseline = random.chance(0.5) ? 0 : random.uniform(0, 3);
    for (std::size_t k = 0; k < stack.layers.size(); ++k)
      for (std::size_t texel = 0; texel < 3; ++texel)
        ASSERT_NEAR(stack.enumerate(k, texel, baseline).mean, stack.derivative(k, texel), 1e-12)
            << "trial " << trial << ", layer " << k << ", texel " << texel;
  }
}

TEST(Score, IsBoundedByOneAndAFloat) {
  Random random(2);
  for (int trial = 0; trial < 200'000; ++trial) {
    float texels[3], weights[3];
    for (float& texel : texels)
      texel = random.chance(0.5) ? float(alphas[random.below(alphas.size())])
                                 : kernels::sigmoid(float(random.uniform(-100, 100)));
    weights[0] = float(random.uniform());
    weights[1] = float(random.uniform() * (1 - double(weights[0])));
    weights[2] = 1 - weights[0] - weights[1];
    float alpha = 0;
    for (int j = 0; j < 3; ++j) alpha += weights[j] * texels[j];
    for (int j = 0; j < 3; ++j) {
      const float won = logit_score(FragmentRole::winner, alpha, weights[j], texels[j]);
      const float lost = logit_score(FragmentRole::in_front, alpha, weights[j], texels[j]);
      ASSERT_TRUE(won >= 0 && won <= 1) << won;
      ASSERT_TRUE(lost <= 0 && lost >= -1) << lost;
    }
  }
}

TEST(Score, OfOneTexelIsWonMinusAlpha) {
  for (const double a : alphas) {
    EXPECT_NEAR(logit_score(FragmentRole::winner, a, 1.0, a), a > 0 ? 1 - a : 0, 1e-15);
    EXPECT_NEAR(logit_score(FragmentRole::in_front, a, 1.0, a), a < 1 ? -a : 0, 1e-9);
  }
}

TEST(Score, WhatIsNoNumberStaysNone) {
  for (const FragmentRole role : {FragmentRole::winner, FragmentRole::in_front})
    EXPECT_TRUE(std::isnan(logit_score(role, NAN, 0.5f, NAN)));
}

TEST(Score, ABaselineLowersTheVariance) {
  // Four fragments of alpha 1/2 with losses like those in the middle of a training. The baseline is
  // the mean of the pixel's loss, which a running mean converges to.
  Random random(3);
  double without = 0, with = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    Stack stack;
    for (int i = 0; i < 4; ++i)
      stack.layers.push_back(
          {.texels = {0.5, 0.5, 0.5}, .weights = {1, 0, 0}, .loss = random.uniform(0.1, 0.5)});
    stack.background_loss = random.uniform(0.1, 0.5);
    double mean = 0;
    for (std::size_t i = 0; i <= 4; ++i) mean += stack.probability(i) * stack.loss(i);
    for (std::size_t k = 0; k < 4; ++k) {
      without += stack.enumerate(k, 0, 0).variance;
      with += stack.enumerate(k, 0, mean).variance;
    }
  }
  const double factor = std::sqrt(without / with);
  RecordProperty("deviation_falls_by", std::to_string(factor));
  EXPECT_GT(factor, 2.5);
}

float logit(double alpha) {
  return alpha <= 0 ? -200.0f : alpha >= 1 ? 200.0f : float(std::log(alpha / (1 - alpha)));
}

// Three faces that cover the whole image, one behind the other, with given alphas for all their
// texels.
class ScoreThroughTheStep : public testing::TestWithParam<int> {
 protected:
  static std::vector<glm::vec3> positions() {
    std::vector<glm::vec3> result;
    for (const float z : {-2.0f, -2.5f, -3.0f})
      result.insert(result.end(), {{-9, -8, z}, {9, -7, z}, {0.5f, 12, z - 0.3f}});
    return result;
  }
};

TEST_P(ScoreThroughTheStep, HasTheDerivativeAsItsMean) {
  constexpr int side = 48, steps = 300;
  constexpr double losses[4] = {0.3, 1.1, 0.2, 0.7};
  // The texels of the three faces: the middle face has one alpha from the list, or all are mixed.
  constexpr double values[5] = {0, 1e-7, 0.5, 1 - 1e-7, 1};
  test::Faces faces(positions());
  for (std::size_t i = 0; i < 9; ++i) {
    const double alpha =
        GetParam() < 5 ? (i / 3 == 1 ? values[GetParam()] : 0.5) : values[(i * 2 + i / 3) % 5];
    faces.model.logits[i * channels + alpha_channel] = logit(alpha);
  }
  faces.refresh();

  // The expected gradient, pixel by pixel, with the step's float alphas.
  std::vector<BatchImage> images{test::make_image(test::axis_camera(side, side, 24))};
  BatchImage& image = images[0];
  double expected[9] = {}, variance[9] = {};
  std::vector<Stack> stacks(image.pixels(), {.layers = {}, .background_loss = losses[3]});
  for (std::size_t face = 0; face < 3; ++face)
    test::for_each_fragment(
        image.view, kernels::project(image.view, &faces.model.positions[3 * face].x),
        {0, 0, side, side}, [&](const kernels::Fragment& f) {
          Layer layer{.loss = losses[face]};
          const auto at = lattice::footprint(0, double(f.b0), double(f.b1));
          for (std::size_t j = 0; j < 3; ++j) {
            layer.texels[at.texels[j]] = faces.store.alpha[3 * face + at.texels[j]];
            layer.weights[at.texels[j]] = at.weights[j];
          }
          stacks[std::size_t(f.y) * side + f.x].layers.push_back(layer);
        });
  for (const Stack& stack : stacks) {
    ASSERT_EQ(stack.layers.size(), 3u);
    for (std::size_t i = 0; i < 9; ++i) {
      expected[i] += stack.derivative(i / 3, i % 3);
      variance[i] += stack.enumerate(i / 3, i % 3, 0).variance;
    }
  }

  double sum[9] = {};
  for (int step = 0; step < steps; ++step) {
    image.draw_key = kernels::draw_key(5, std::uint32_t(step), 0);
    faces.find(image, Masking::stochastic);
    for (std::size_t pixel = 0; pixel < image.pixels(); ++pixel) {
      const std::uint32_t face = image.visible[pixel].face;
      image.loss[pixel] = float(losses[face == no_face ? 3 : face]);
    }
    for (std::size_t face = 0; face < 3; ++face) {
      ASSERT_EQ(faces.gather(images, face), 0u);
      for (std::size_t texel = 0; texel < 3; ++texel)
        sum[3 * face + texel] += faces.by_logit(face, texel, alpha_channel);
    }
  }
  for (std::size_t i = 0; i < 9; ++i) {
    // Float sums of 2304 terms of up to 1 have errors of about 1e-5 of their total. Draws are
    // multiples of 2^-24, which changes each pixel's probability by as much.
    const double rounding = 1e-5 * std::abs(expected[i]) + image.pixels() * 3 * 0x1p-24;
    const double standard_error = std::sqrt(std::max(variance[i], 0.0) / steps);
    EXPECT_NEAR(sum[i] / steps, expected[i], 4 * standard_error + rounding)
        << "face " << i / 3 << ", texel " << i % 3;
  }
}

std::string case_name(const testing::TestParamInfo<int>& tested) {
  constexpr const char* names[] = {"OfAlpha0",          "OfAlpha1Em7", "OfAlphaOneHalf",
                                   "OfAlpha1Minus1Em7", "OfAlpha1",    "OfMixedTexels"};
  return names[tested.param];
}

INSTANTIATE_TEST_SUITE_P(, ScoreThroughTheStep, testing::Range(0, 6), case_name);

TEST(ScoreOfCoincidentFaces, TheOneBehindByItsNumberGetsNothing) {
  // docs/numerics.md, G9. Both faces cover everything. The lower one shows wherever it is accepted,
  // and the other then has no effect on the pixel. The other's score is that of a fragment reached
  // only if the lower one is rejected.
  constexpr int side = 32, steps = 200;
  std::vector<glm::vec3> positions{{-9, -8, -2}, {9, -7, -2}, {0.5f, 12, -2}};
  for (int k = 0; k < 3; ++k) positions.push_back(positions[std::size_t(k)]);
  test::Faces faces(positions, 0.0f);  // alpha 1/2
  std::vector<BatchImage> images{test::make_image(test::axis_camera(side, side, 16))};
  BatchImage& image = images[0];
  const double losses[3] = {1.0, 0.2, 0.6};
  double sum[2] = {};
  for (int step = 0; step < steps; ++step) {
    image.draw_key = kernels::draw_key(6, std::uint32_t(step), 0);
    faces.find(image, Masking::stochastic);
    for (std::size_t pixel = 0; pixel < image.pixels(); ++pixel)
      image.loss[pixel] = float(losses[std::min(image.visible[pixel].face, 2u)]);
    for (std::size_t face = 0; face < 2; ++face) {
      faces.gather(images, face);
      for (std::size_t texel = 0; texel < 3; ++texel)
        sum[face] += faces.by_logit(face, texel, alpha_channel) / steps;
    }
  }
  const double pixels = side * side;
  // All texels have alpha a = 1/2, so for a common logit: a (1 - a) T (l - E[l | rejected]).
  const double expected[2] = {0.25 * (1.0 - (0.5 * 0.2 + 0.5 * 0.6)) * pixels,
                              0.25 * 0.5 * (0.2 - 0.6) * pixels};
  // A pixel's contribution has a deviation below 1/2.
  const double tolerance = 4 * 0.5 * std::sqrt(pixels / steps);
  EXPECT_NEAR(sum[0], expected[0], tolerance);
  EXPECT_NEAR(sum[1], expected[1], tolerance);
}

}  // namespace score_test
}  // namespace tureen::trainer
