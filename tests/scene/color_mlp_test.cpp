// The color MLP as known values, and the limits of materials.
#include "scene/color_mlp.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "scene/triangle_soup.hpp"

namespace tureen {
namespace color_mlp_test {

double sigmoid(double x) { return 1 / (1 + std::exp(-x)); }

/// One layer: red sees the direction's x, green its y, blue the first feature.
ColorMlp one_layer(ViewConvention view) {
  return {.layers = {{.inputs = 4,
                      .outputs = 3,
                      .weights = {0, 1, 0, 0, 0, 0, 1, 0, 2, 0, 0, 0},
                      .biases = {0, 0, 0.5f}}},
          .encoding = DirectionEncoding::xyz,
          .view = view,
          .blend_channel = {}};
}

TEST(ColorMlp, SeesTheDirectionOfItsConvention) {
  const std::vector<double> features{0.25};
  const glm::dvec3 to_eye(0.6, -0.8, 0);
  const glm::dvec3 color = evaluate(one_layer(ViewConvention::surface_to_eye), features, to_eye);
  EXPECT_NEAR(color.r, sigmoid(0.6), 1e-12);
  EXPECT_NEAR(color.g, sigmoid(-0.8), 1e-12);
  EXPECT_NEAR(color.b, sigmoid(1), 1e-12);
  const glm::dvec3 other = evaluate(one_layer(ViewConvention::eye_to_surface), features, to_eye);
  EXPECT_NEAR(other.r, sigmoid(-0.6), 1e-12);
  EXPECT_NEAR(other.g, sigmoid(0.8), 1e-12);
}

TEST(UvMaterials, HaveAMaskInOneOfFourChannels) {
  TriangleSoup soup;
  soup.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  soup.triangles = {{0, 1, 2}};
  for (const int channel : {-1, 0, 3, 4}) {
    UvTextures textures;
    textures.uv = {{0, 0}, {1, 0}, {0, 1}};
    textures.material_of_face = {0};
    textures.materials.resize(1);
    textures.materials[0].images = {0};
    textures.materials[0].mask_channel = channel;
    textures.images = {Image8(2, 2)};
    soup.appearance = textures;
    EXPECT_EQ(defect(soup).has_value(), channel < 0 || channel > 3) << channel;
  }
}

}  // namespace color_mlp_test
}  // namespace tureen
