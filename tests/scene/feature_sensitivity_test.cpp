// Sensitivity of colour to features, against values computed by hand.
#include "scene/edit/feature_sensitivity.hpp"

#include <gtest/gtest.h>

#include <glm/vec3.hpp>

#include "scene/lattice.hpp"

namespace tureen {
namespace feature_sensitivity_test {

constexpr int features = LatticeTexture::features;
const std::vector<glm::dvec3> eyes{{0, 0, 5}, {3, 0, 4}};

/// Two faces of level 1 with all features at 1/2; the second one transparent.
TriangleSoup plain_soup() {
  TriangleSoup soup;
  soup.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  soup.triangles = {{0, 1, 2}, {2, 1, 0}};
  LatticeTexture texture;
  texture.patches = {{0, 1}, {6, 1}};
  std::vector<float> texels(12 * LatticeTexture::channels, 0.5f);
  for (std::size_t i = 6; i < 12; ++i) texels[i * LatticeTexture::channels + features] = 0.0f;
  texture.texels = std::move(texels);
  soup.appearance = std::move(texture);
  return soup;
}

TEST(FeatureSensitivity, WithoutANetworkItIsThatOfThreeColours) {
  const FeatureMatrix s = mean_sensitivity(plain_soup(), eyes, {}, 100);
  for (std::size_t i = 0; i < features; ++i)
    for (std::size_t j = 0; j < features; ++j)
      EXPECT_NEAR(s[i][j], i == j && i < 3 ? 1.0 : 0.0, 1e-9) << i << ", " << j;
}

TEST(FeatureSensitivity, FollowsTheNetworksSlopes) {
  TriangleSoup soup = plain_soup();
  // One layer and a sigmoid with the input 0, where its slope is 1/4.
  ColorMlp mlp;
  mlp.encoding = DirectionEncoding::none;
  DenseLayer layer{features, 3, std::vector<float>(3 * features, 0.0f), {0, 0, 0}};
  layer.weights[0] = 0.8f;             // red follows f0
  layer.weights[features + 5] = 0.4f;  // green follows f5
  layer.biases = {-0.4f, -0.2f, 0.0f};
  mlp.layers = {layer};
  std::get<LatticeTexture>(soup.appearance).mlp = mlp;
  const FeatureMatrix s = mean_sensitivity(soup, eyes, {}, 100);
  // The finite difference changes the sigmoid's slope by about (0.8 * 12/255)^2 / 12, relatively.
  EXPECT_NEAR(s[0][0], 0.2 * 0.2, 1e-4);
  EXPECT_NEAR(s[5][5], 0.1 * 0.1, 1e-4);
  EXPECT_NEAR(s[0][5], 0.0, 1e-9);
  EXPECT_NEAR(s[1][1], 0.0, 1e-9);
}

TEST(FeatureSensitivity, FacesCountAsTheyAreShown) {
  TriangleSoup soup = plain_soup();
  auto& texture = std::get<LatticeTexture>(soup.appearance);
  auto& texels = std::get<std::vector<float>>(texture.texels);
  // Both faces are visible. At the second one, the sigmoid of red is flat.
  for (std::size_t i = 6; i < 12; ++i) {
    texels[i * LatticeTexture::channels + features] = 1.0f;
    texels[i * LatticeTexture::channels] = 1.0f;
  }
  ColorMlp mlp;
  mlp.encoding = DirectionEncoding::none;
  DenseLayer layer{features, 3, std::vector<float>(3 * features, 0.0f), {-20, 0, 0}};
  layer.weights[0] = 40.0f;
  mlp.layers = {layer};
  texture.mlp = mlp;
  const auto red = [&](const std::vector<double>& shown) {
    return mean_sensitivity(soup, eyes, shown, 2000)[0][0];
  };
  const double steep = red({1, 0}), flat = red({0, 1});
  EXPECT_GT(steep, 10.0);
  EXPECT_LT(flat, 1e-6);
  // A quarter of 2,000 samples: the standard deviation is about 10, and the tolerance is 6 of them.
  EXPECT_NEAR(red({1, 3}) / steep, 0.25, 0.03);
  EXPECT_NEAR(red({}) / steep, 0.5, 0.07);
}

TEST(FeatureSensitivity, AFaceMovesAsFarAsItsSteps) {
  std::array<double, features> step{};
  step[0] = 0.03;
  step[1] = 0.04;
  step[4] = 0.5;  // no colour
  const std::vector<std::array<double, features>> steps{step, step};
  const std::vector<double> moved = face_sensitivity(plain_soup(), eyes, steps);
  ASSERT_EQ(moved.size(), 2u);
  for (const double m : moved) EXPECT_NEAR(m, 2 * (0.03 * 0.03 + 0.04 * 0.04), 1e-9);
}

TEST(FeatureSensitivity, ASoupOfNothingHasNone) {
  TriangleSoup soup;
  soup.appearance = LatticeTexture{};
  EXPECT_EQ(mean_sensitivity(soup, eyes), FeatureMatrix{});
  EXPECT_TRUE(face_sensitivity(soup, eyes, {}).empty());
}

}  // namespace feature_sensitivity_test
}  // namespace tureen
