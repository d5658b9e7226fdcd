// mean_colors against slower, simple means.
#include "scene/edit/mean_color.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <random>

#include "image/srgb.hpp"
#include "scene/lattice.hpp"
#include "scene/spherical_harmonics.hpp"

namespace tureen {
namespace mean_color_test {

void expect_near(const glm::vec3& a, const glm::dvec3& b, double tolerance) {
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(a[k], b[k], tolerance) << "channel " << k;
}

TriangleSoup one_face() {
  TriangleSoup soup;
  soup.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  soup.triangles = {{0, 1, 2}};
  return soup;
}

std::vector<glm::dvec3> sphere(int count) {  // Fibonacci's points: nearly uniform
  std::vector<glm::dvec3> points;
  for (int i = 0; i < count; ++i) {
    const double z = 1.0 - 2.0 * (i + 0.5) / count, r = std::sqrt(1.0 - z * z);
    const double a = i * 2.399963229728653;
    points.emplace_back(r * std::cos(a), r * std::sin(a), z);
  }
  return points;
}

ColorMlp random_mlp(std::mt19937& engine, DirectionEncoding encoding, int features,
                    std::optional<int> blend) {
  std::normal_distribution<float> normal(0.0f, 0.35f);
  ColorMlp mlp;
  mlp.encoding = encoding;
  mlp.blend_channel = blend;
  const int widths[] = {features + encoded_size(encoding), 16, 16, 3};
  for (int i = 0; i < 3; ++i) {
    DenseLayer layer{widths[i], widths[i + 1], {}, {}};
    for (int k = 0; k < layer.inputs * layer.outputs; ++k) layer.weights.push_back(normal(engine));
    for (int k = 0; k < layer.outputs; ++k) layer.biases.push_back(normal(engine));
    mlp.layers.push_back(layer);
  }
  return mlp;
}

TEST(MeanColor, SrgbTransferIsItsOwnInverse) {
  for (int i = 0; i <= 255; ++i)
    EXPECT_NEAR(srgb_from_linear(linear_from_srgb(i / 255.0)), i / 255.0, 1e-12);
  EXPECT_NEAR(linear_from_srgb(0.5), 0.21404114, 1e-8);
  EXPECT_EQ(linear_from_srgb(std::nan("")), 0.0);
  EXPECT_EQ(srgb_from_linear(7.0), 1.0);
}

TEST(MeanColor, FaceColoursAreThemselves) {
  TriangleSoup soup = one_face();
  soup.appearance = FaceColors{{{0.25f, 0.5f, 1.5f, 0.1f}}};
  expect_near(mean_colors(soup)[0], {0.25, 0.5, 1.0}, 0);
}

TEST(MeanColor, CutOutVertexColoursCountOnlyWhatIsSeen) {
  TriangleSoup soup = one_face();
  // Alpha falls from 1 at the red corner to 0 at the other two. The visible part is the corner
  // piece with half the side, whose centroid is 2/3 red.
  soup.appearance = VertexColors{{{1, 0, 0, 1}, {0, 1, 0, 0}, {0, 1, 0, 0}}};
  // The 16 samples are coarse: a tolerance of a tenth.
  expect_near(mean_colors(soup)[0], {2.0 / 3.0, 1.0 / 3.0, 0.0}, 0.1);
  soup.appearance = VertexColors{{{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}}};
  expect_near(mean_colors(soup)[0], glm::dvec3(1.0 / 3.0), 1e-6);
}

TEST(MeanColor, HarmonicsThatNeverClampKeepOnlyTheirConstant) {
  std::mt19937 engine(1);
  std::uniform_real_distribution<float> small(-0.02f, 0.02f);
  TriangleSoup soup = one_face();
  for (int degree = 0; degree <= 4; ++degree) {
    Harmonics sh{Harmonics::Domain::face, degree, ViewConvention::eye_to_surface, {}};
    for (int k = 0; k < harmonics::count(degree); ++k)
      sh.coefficients.emplace_back(small(engine), small(engine), small(engine));
    sh.coefficients[0] = {0.3f, -0.4f, 0.1f};
    soup.appearance = sh;
    expect_near(mean_colors(soup)[0], 0.5 + harmonics::y00 * glm::dvec3(sh.coefficients[0]), 1e-6);
  }
}

TEST(MeanColor, HarmonicsThatClampStayNearADenseMean) {
  std::mt19937 engine(2);
  std::uniform_real_distribution<float> large(-0.8f, 0.8f);
  TriangleSoup soup = one_face();
  Harmonics sh{Harmonics::Domain::face, 3, ViewConvention::eye_to_surface, {}};
  for (int k = 0; k < 16; ++k)
    sh.coefficients.emplace_back(large(engine), large(engine), large(engine));
  glm::dvec3 dense(0.0);
  const auto points = sphere(20000);
  for (const glm::dvec3& d : points) {
    const auto basis = harmonics::basis(d);
    glm::dvec3 c(0.5);
    for (int k = 0; k < 16; ++k) c += basis[k] * glm::dvec3(sh.coefficients[k]);
    dense += glm::clamp(c, 0.0, 1.0) / double(points.size());
  }
  soup.appearance = sh;
  // Clamping causes a kink, which no small quadrature integrates exactly.
  expect_near(mean_colors(soup)[0], dense, 0.05);
}

TEST(MeanColor, LatticeCountsVisibleTexelsByTheirArea) {
  TriangleSoup soup = one_face();
  for (const int level : {0, 1, 3}) {
    // Features are linear over the face: their exact mean is the mean of the corners.
    LatticeTexture texture;
    texture.patches = {{0, std::uint32_t(level)}};
    std::vector<float> texels;
    const int n = lattice::resolution(level);
    for (std::uint32_t i = 0; i < lattice::texel_count(level); ++i) {
      const auto [x, y] = lattice::texel_coordinates(i);
      const float b0 = float(x) / float(n), b1 = float(y) / float(n);
      texels.insert(texels.end(), {b0, b1, 1 - b0 - b1, 0, 0, 0, 0, 1});
    }
    texture.texels = texels;
    soup.appearance = texture;
    expect_near(mean_colors(soup)[0], glm::dvec3(1.0 / 3.0), 1e-6);
    // Only the texel of vertex 0 is visible.
    for (std::size_t i = 0; i < texels.size(); i += 8) texels[i + 7] = texels[i] == 1.0f;
    texture.texels = texels;
    soup.appearance = texture;
    expect_near(mean_colors(soup)[0], {1, 0, 0}, 1e-6);
  }
}

TEST(MeanColor, MlpAgreesWithTheDoubleOne) {
  for (const unsigned seed : {3u, 4u, 5u}) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 engine(seed);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    TriangleSoup soup = one_face();
    LatticeTexture texture;
    texture.patches = {{0, 0}};
    std::vector<float> texels;
    for (int i = 0; i < 24; ++i) texels.push_back(i % 8 == 7 ? 1.0f : unit(engine));
    texture.texels = texels;
    texture.mlp = random_mlp(engine, DirectionEncoding::harmonics2, 7, 3);
    glm::dvec3 dense(0.0);
    const auto points = sphere(4000);
    for (int i = 0; i < 3; ++i) {
      const float* texel = &texels[8 * std::size_t(i)];
      const std::vector<double> features(texel, texel + 7);
      for (const glm::dvec3& d : points)
        dense += evaluate(*texture.mlp, features, d) / (3.0 * double(points.size()));
    }
    soup.appearance = texture;
    // The network is smooth, with inputs of degree 2, but it is not a polynomial of degree 7.
    expect_near(mean_colors(soup)[0], dense, 2e-3);
  }
}

TEST(MeanColor, UvTexturesHonourMaskWrapAndFactor) {
  TriangleSoup soup = one_face();
  UvTextures textures;
  textures.uv = {{2, 0}, {4, 0}, {2, 2}};  // each texel of the repeated image equally often
  textures.material_of_face = {0};
  textures.images = {Image8(1, 1, {255, 51, 0, 255})};
  textures.materials = {{.images = {0}, .factor = {0.5f, 1, 1, 1}, .mask_threshold = 0.5f}};
  soup.appearance = textures;
  expect_near(mean_colors(soup)[0], {0.5, 0.2, 0.0}, 1e-6);
  // Left half red and visible, right half green and cut out.
  textures.images = {Image8(2, 1)};
  textures.images[0].pixels = {{255, 0, 0, 255}, {0, 255, 0, 0}};
  textures.uv = {{0, 0}, {1, 0}, {0, 1}};
  textures.materials[0].factor = glm::vec4(1.0f);
  soup.appearance = textures;
  expect_near(mean_colors(soup)[0], {1, 0, 0}, 1e-6);
}

TEST(MeanColor, IsDeterministic) {
  std::mt19937 engine(6);
  TriangleSoup soup;
  constexpr int faces = 300;
  soup.positions.resize(3 * faces);
  LatticeTexture texture;
  for (unsigned t = 0; t < faces; ++t) {
    soup.triangles.emplace_back(3 * t, 3 * t + 1, 3 * t + 2);
    texture.patches.push_back({t * lattice::texel_count(5), 5});
  }
  std::vector<std::uint8_t> texels(faces * lattice::texel_count(5) * 8);
  for (auto& b : texels) b = std::uint8_t(engine());
  texture.texels = texels;
  texture.mlp = random_mlp(engine, DirectionEncoding::harmonics2, 7, 3);
  soup.appearance = texture;
  EXPECT_EQ(mean_colors(soup), mean_colors(soup));
}

}  // namespace mean_color_test
}  // namespace tureen
