// The oracle's shading of a point, against values computed by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "oracle/shade.hpp"
#include "oracle/uv_sampling.hpp"
#include "scene/lattice.hpp"
#include "scene/spherical_harmonics.hpp"
#include "tests/support/random_soups.hpp"

namespace tureen {
namespace oracle_shading_test {

const glm::dvec3 to_eye(0, 0, 1);
const glm::dvec3 eye(0, 0, 5);

TriangleSoup one_face(Appearance appearance) {
  TriangleSoup soup;
  soup.positions = {{1, 0, 0}, {0, 1, 0}, {-1, -1, 0}};
  soup.triangles = {{0, 1, 2}};
  soup.appearance = std::move(appearance);
  EXPECT_EQ(defect(soup), std::nullopt);
  return soup;
}

void expect_color(glm::dvec3 actual, glm::dvec3 expected, double tolerance = 1e-12) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(actual[c], expected[c], tolerance) << "channel " << c;
}

TEST(OracleShading, FaceColorsAreDrawnFromTheThresholdUp) {
  for (const auto& [alpha, drawn] : {std::pair{0.0f, false},
                                     {std::nextafter(0.5f, 0.0f), false},
                                     {0.5f, true},
                                     {1.0f, true},
                                     {std::numeric_limits<float>::quiet_NaN(), false}}) {
    const TriangleSoup soup = one_face(FaceColors{{{0.2f, 0.4f, 1.5f, alpha}}});
    EXPECT_EQ(oracle::is_visible(soup, {0, 0.3, 0.3}), drawn) << alpha;
    expect_color(oracle::color(soup, {0, 0.3, 0.3}, to_eye, eye), {0.2f, 0.4f, 1.0});
  }
}

TEST(OracleShading, VertexColorsAndTheirAlphaAreInterpolated) {
  const TriangleSoup soup = one_face(VertexColors{{{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 0}}});
  expect_color(oracle::color(soup, {0, 0.25, 0.5}, to_eye, eye), {0.25, 0.5, 0.25});
  EXPECT_TRUE(oracle::is_visible(soup, {0, 0.25, 0.25}));
  EXPECT_FALSE(oracle::is_visible(soup, {0, 0.25, 0.2499}));
}

TEST(OracleShading, AConstantAlphaAtTheThresholdIsVisibleEverywhere) {
  const TriangleSoup soup =
      one_face(VertexColors{{{1, 0, 0, 0.5f}, {0, 1, 0, 0.5f}, {0, 0, 1, 0.5f}}});
  test::Random random(1);
  for (int i = 0; i < 1000; ++i)
    ASSERT_TRUE(oracle::is_visible(soup, {0, random.uniform(), random.uniform()}));
}

TEST(OracleShading, FaceHarmonicsLookFromTheCentroidByTheirConvention) {
  // Degree 1, only the z function: 1/2 + 0.4886 z c. The centroid is the origin.
  Harmonics sh{.domain = Harmonics::Domain::face, .degree = 1, .coefficients = {}};
  sh.coefficients = {glm::vec3(0), glm::vec3(0), {0.5f, -0.25f, 4.0f}, glm::vec3(0)};
  const double y = 0.48860251190291992;
  // The eye is at +z, so a ray from it runs towards -z.
  expect_color(oracle::color(one_face(sh), {0, 0.9, 0.1}, to_eye, eye),
               {0.5 - 0.5 * y, 0.5 + 0.25 * y, 0.0});
  sh.view = ViewConvention::surface_to_eye;
  expect_color(oracle::color(one_face(sh), {0, 0.1, 0.1}, to_eye, eye),
               {0.5 + 0.5 * y, 0.5 - 0.25 * y, 1.0});
  EXPECT_TRUE(oracle::is_visible(one_face(sh), {0, 0.1, 0.1}));
  // An eye at the centroid gives (0, 0, 1) in either convention.
  expect_color(oracle::color(one_face(sh), {0, 0.1, 0.1}, to_eye, glm::dvec3(0)),
               {0.5 + 0.5 * y, 0.5 - 0.25 * y, 1.0});
}

TEST(OracleShading, VertexHarmonicsAreClampedBeforeTheyAreInterpolated) {
  // Degree 0: 1/2 + Y00 c = -1 -> 0, 0.75, 2 -> 1 in every channel.
  const auto coefficient = [](double value) {
    return glm::vec3(float((value - 0.5) / harmonics::y00));
  };
  Harmonics sh{.domain = Harmonics::Domain::vertex, .degree = 0, .coefficients = {}};
  sh.coefficients = {coefficient(-1), coefficient(0.75), coefficient(2)};
  expect_color(oracle::color(one_face(sh), {0, 0.5, 0.25}, to_eye, eye),
               glm::dvec3(0.25 * 0.75 + 0.25), 1e-6);
}

TEST(OracleShading, LatticesReturnTheirTexelsAtLatticePoints) {
  for (int level = 0; level <= lattice::max_level; ++level)
    for (const bool as_float : {false, true}) {
      const TriangleSoup soup = test::random_soup(
          std::uint64_t(level),
          {.kind = test::Kind::lattice, .faces = 3, .level = level, .float_texels = as_float});
      const auto& texture = std::get<LatticeTexture>(soup.appearance);
      const int n = lattice::resolution(level);
      for (std::uint32_t face = 0; face < 3; ++face)
        for (std::uint32_t i = 0; i < lattice::texel_count(level); ++i) {
          const auto [x, y] = lattice::texel_coordinates(i);
          const oracle::SurfacePoint point{face, double(x) / n, double(y) / n};
          const std::size_t texel = texture.patches[face].first_texel + i;
          // value() returns a rounded float.
          expect_color(oracle::color(soup, point, to_eye, eye),
                       {texture.value(texel, 0), texture.value(texel, 1), texture.value(texel, 2)},
                       1e-7);
          EXPECT_EQ(oracle::is_visible(soup, point), texture.value(texel, 7) >= 0.5f);
        }
    }
}

// Negative values become 0, and sums above 1 are normalised, as in simplex.glsl.
TEST(OracleShading, PointsBesideTheFaceTakeTheLatticeOfItsRim) {
  const TriangleSoup soup = test::random_soup(
      7, {.kind = test::Kind::lattice, .faces = 1, .level = 3, .float_texels = true});
  for (const auto& [outside, rim] : {std::pair{glm::dvec2(-0.3, 0.4), glm::dvec2(0, 0.4)},
                                     {{1.5, 0.5}, {0.75, 0.25}},
                                     {{1.5, -0.2}, {1, 0}},
                                     {{0.25, -1e9}, {0.25, 0}},
                                     {{0.25, 1}, {0.2, 0.8}}})
    expect_color(oracle::color(soup, {0, outside.x, outside.y}, to_eye, eye),
                 oracle::color(soup, {0, rim.x, rim.y}, to_eye, eye));
}

TEST(OracleShading, TheColorMlpSeesInterpolatedFeatures) {
  const TriangleSoup soup =
      test::random_soup(8, {.kind = test::Kind::lattice_mlp, .faces = 1, .level = 0});
  const auto& texture = std::get<LatticeTexture>(soup.appearance);
  // Level 0 has the texels of vertices 2, 0, 1 in that order.
  const double weights[3] = {0.25, 0.25, 0.5};
  std::array<double, 7> features{};
  for (int c = 0; c < 7; ++c)
    for (int k = 0; k < 3; ++k) features[c] += weights[k] * texture.value(k, c);
  const glm::dvec3 direction = glm::normalize(glm::dvec3(1, 2, -3));
  expect_color(oracle::color(soup, {0, 0.25, 0.5}, direction, eye),
               evaluate(*texture.mlp, features, direction), 1e-6);
}

// -- UV textures -------------------------------------------------------------------------------

/// Three by two texels; the red byte identifies the texel: 10 x + 100 y.
Image8 numbered_image() {
  Image8 image(3, 2);
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 3; ++x) image.at(x, y) = glm::u8vec4(10 * x + 100 * y, 0, 0, 255);
  return image;
}

double red(const UvMaterial& material, double x, double y) {
  return 255 * oracle::sample(numbered_image(), material, {x / 3, y / 2}).r;
}

TEST(OracleUvSampling, NearestTakesTheTexelAndWraps) {
  using Wrap = UvMaterial::Wrap;
  struct Case {
    Wrap wrap;
    double x, y;  // texels from the top left corner
    double expected;
  };
  const Case cases[] = {
      {Wrap::repeat, 0.5, 0.5, 0},        {Wrap::repeat, 2.9, 1.1, 120},
      {Wrap::repeat, 3.5, 0.5, 0},        {Wrap::repeat, -0.5, 0.5, 20},
      {Wrap::repeat, 0.5, 2.5, 0},        {Wrap::repeat, 0.5, -0.5, 100},
      {Wrap::mirror, 3.5, 0.5, 20},       {Wrap::mirror, 5.5, 0.5, 0},
      {Wrap::mirror, 6.5, 0.5, 0},        {Wrap::mirror, -0.5, 0.5, 0},
      {Wrap::mirror, -1.5, 0.5, 10},      {Wrap::clamp, 3.5, 0.5, 20},
      {Wrap::clamp, -9.0, 9.0, 100},      {Wrap::clamp, 3.0, 2.0, 120},
      {Wrap::repeat, 3e6 + 1.5, 0.5, 10},
  };
  for (const Case& c : cases) {
    UvMaterial material{
        .images = {0}, .wrap_u = c.wrap, .wrap_v = c.wrap, .filter = UvMaterial::Filter::nearest};
    EXPECT_NEAR(red(material, c.x, c.y), c.expected, 1e-9) << c.x << ", " << c.y;
  }
}

TEST(OracleUvSampling, LinearBlendsAcrossTheWrappedBorder) {
  using Wrap = UvMaterial::Wrap;
  struct Case {
    Wrap wrap;
    double x, y;
    double expected;
  };
  const Case cases[] = {
      {Wrap::repeat, 1.0, 0.5, 5}, {Wrap::repeat, 1.25, 1.0, 57.5}, {Wrap::repeat, 0.0, 0.5, 10},
      {Wrap::mirror, 0.0, 0.5, 0}, {Wrap::mirror, 3.0, 0.5, 20},    {Wrap::mirror, 4.0, 0.5, 15},
      {Wrap::clamp, 0.0, 0.5, 0},  {Wrap::clamp, 4.0, 0.0, 20},     {Wrap::repeat, 0.5, 0.0, 50},
  };
  for (const Case& c : cases) {
    UvMaterial material{
        .images = {0}, .wrap_u = c.wrap, .wrap_v = c.wrap, .filter = UvMaterial::Filter::linear};
    EXPECT_NEAR(red(material, c.x, c.y), c.expected, 1e-9) << c.x << ", " << c.y;
  }
}

TEST(OracleUvSampling, CoordinatesThatAreNotFiniteOrHugeStayInTheImage) {
  for (const double bad : {double(NAN), double(INFINITY), -double(INFINITY), 1e30, -1e300})
    for (const auto wrap :
         {UvMaterial::Wrap::repeat, UvMaterial::Wrap::mirror, UvMaterial::Wrap::clamp})
      for (const auto filter : {UvMaterial::Filter::nearest, UvMaterial::Filter::linear}) {
        const UvMaterial material{.images = {0}, .wrap_u = wrap, .wrap_v = wrap, .filter = filter};
        const double value = red(material, bad, bad);
        EXPECT_TRUE(value >= 0 && value <= 120) << bad;
      }
}

UvTextures one_texture(UvMaterial material) {
  UvTextures textures;
  // Constant over the face: the centre of texel (1, 1).
  textures.uv.assign(3, glm::vec2(0.5f, 0.75f));
  textures.material_of_face = {0};
  textures.materials = {std::move(material)};
  Image8 image(3, 2);
  image.at(1, 1) = {255, 51, 102, 153};
  textures.images = {image, image};
  return textures;
}

TEST(OracleShading, TexturesAreTintedByFactorAndVertexColour) {
  UvTextures textures = one_texture({.images = {0}, .factor = {0.5f, 1, 1, 1}});
  expect_color(oracle::color(one_face(textures), {0, 0.2, 0.2}, to_eye, eye), {0.5, 0.2, 0.4});
  textures.vertex_rgba.assign(3, glm::vec4(1, 0.5f, 1, 0.5f));
  expect_color(oracle::color(one_face(textures), {0, 0.2, 0.2}, to_eye, eye), {0.5, 0.1, 0.4});
  textures.materials[0].images.clear();  // the factor alone
  expect_color(oracle::color(one_face(textures), {0, 0.2, 0.2}, to_eye, eye), {0.5, 0.5, 1.0});
}

TEST(OracleShading, MasksCutByTheTintedChannel) {
  // Alpha 153 / 255 = 0.6; half a vertex alpha makes it 0.3.
  UvTextures textures = one_texture({.images = {0}, .mask_threshold = 0.5f});
  EXPECT_TRUE(oracle::is_visible(one_face(textures), {0, 0.2, 0.2}));
  textures.vertex_rgba.assign(3, glm::vec4(1, 1, 1, 0.5f));
  EXPECT_FALSE(oracle::is_visible(one_face(textures), {0, 0.2, 0.2}));
  textures.materials[0].mask_channel = 0;
  EXPECT_TRUE(oracle::is_visible(one_face(textures), {0, 0.2, 0.2}));
  textures.materials[0].mask_channel = 3;
  textures.materials[0].mask_threshold = 0;
  EXPECT_TRUE(oracle::is_visible(one_face(textures), {0, 0.2, 0.2}));
}

TEST(OracleShading, FeatureTexturesFeedTheirMlpAndIgnoreTheFactor) {
  test::Random random(9);
  UvTextures textures =
      one_texture({.images = {0, 1}, .factor = glm::vec4(0.1f), .mask_threshold = 0.5f});
  textures.mlp = test::random_uv_mlp(random);
  const double one[4] = {1.0, 0.2, 0.4, 0.6};
  std::array<double, 8> features;
  for (int c = 0; c < 8; ++c) features[c] = one[c % 4];
  const glm::dvec3 direction = glm::normalize(glm::dvec3(-1, 2, 3));
  EXPECT_TRUE(oracle::is_visible(one_face(textures), {0, 0.2, 0.2}));
  expect_color(oracle::color(one_face(textures), {0, 0.2, 0.2}, direction, eye),
               evaluate(*textures.mlp, features, direction));
}

}  // namespace oracle_shading_test
}  // namespace tureen
