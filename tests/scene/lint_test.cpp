#include "scene/lint/lint.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "scene/lattice.hpp"

namespace tureen {
namespace lint_test {

using testing::ElementsAre;
using testing::IsEmpty;

/// Faces with their own corners, all opaque white.
TriangleSoup soup_of(const std::vector<std::array<glm::vec3, 3>>& faces) {
  TriangleSoup soup;
  for (const auto& face : faces) {
    const auto first = std::uint32_t(soup.positions.size());
    soup.positions.insert(soup.positions.end(), face.begin(), face.end());
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  soup.appearance = FaceColors{std::vector<glm::vec4>(faces.size(), glm::vec4(1))};
  return soup;
}

const std::array<glm::vec3, 3> plain{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
const std::array<glm::vec3, 3> other{{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}}};

using Id = LintFinding::Id;

std::vector<Id> ids(const Lint& lint) {
  std::vector<Id> ids;
  for (const LintFinding& finding : lint.findings) ids.push_back(finding.id);
  return ids;
}

/// The finding, or an empty one.
LintFinding found(const Lint& lint, Id id) {
  const LintFinding* finding = lint.find(id);
  return finding ? *finding : LintFinding{};
}

TEST(Lint, ACleanSoupHasNothingToSay) {
  EXPECT_THAT(lint(soup_of({plain, other})).findings, IsEmpty());
  EXPECT_THAT(lint(TriangleSoup{}).findings, IsEmpty());
}

TEST(Lint, FindsVerticesThatAreNotFinite) {
  auto face = other;
  face[1].y = std::numeric_limits<float>::quiet_NaN();
  face[2].z = -std::numeric_limits<float>::infinity();
  const Lint result = lint(soup_of({plain, face}));
  EXPECT_THAT(ids(result), ElementsAre(Id::non_finite_vertices));
  EXPECT_THAT(result.findings[0].first, ElementsAre(4, 5));
  EXPECT_EQ(result.findings[0].of, 6u);
}

TEST(Lint, FindsFacesWithoutArea) {
  const Lint result = lint(soup_of({{{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}},  // on a line
                                    {{{0, 0, 0}, {0, 0, 0}, {1, 0, 0}}},  // two equal corners
                                    {{{5, 5, 5}, {5, 5, 5}, {5, 5, 5}}},  // a point
                                    plain}));
  EXPECT_THAT(found(result, Id::degenerate_faces).first, ElementsAre(0, 1, 2));
}

TEST(Lint, AThinOrTinyFaceIsNotDegenerate) {
  const float s = 1e-15f;
  const Lint result = lint(
      soup_of({{{{0, 0, 0}, {1, 0, 0}, {0.5f, 1e-7f, 0}}}, {{{0, 0, 0}, {s, 0, 0}, {0, s, 0}}}}));
  EXPECT_EQ(found(result, Id::degenerate_faces).count, 0u);
}

TEST(Lint, FindsRepeatedFacesInAnyOrderOfTheirCorners) {
  const std::array<glm::vec3, 3> turned{{plain[2], plain[0], plain[1]}};
  const std::array<glm::vec3, 3> mirrored{{plain[1], plain[0], plain[2]}};
  auto signed_zero = plain;
  signed_zero[0].x = -0.0f;
  auto nearly = plain;
  nearly[1].x = std::nextafter(1.0f, 2.0f);
  const Lint result = lint(soup_of({plain, other, turned, mirrored, signed_zero, nearly}));
  EXPECT_THAT(found(result, Id::duplicate_faces).first, ElementsAre(2, 3, 4));
}

TEST(Lint, DuplicatesAgreeWithComparingAllPairs) {
  const unsigned seed = 11;
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  // Corners on a 2 x 2 x 2 grid: there are only 56 triangles with distinct corners.
  std::uniform_int_distribution<int> bit(0, 1);
  std::vector<std::array<glm::vec3, 3>> faces(200);
  for (auto& face : faces)
    for (glm::vec3& corner : face) corner = {bit(random), bit(random), bit(random)};
  std::size_t expected = 0;
  const auto sorted = [](std::array<glm::vec3, 3> face) {
    const auto key = [](const glm::vec3& p) { return p.x * 4 + p.y * 2 + p.z; };
    std::sort(face.begin(), face.end(),
              [&](const auto& a, const auto& b) { return key(a) < key(b); });
    return face;
  };
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const auto face = sorted(faces[i]);
    if (face[0] == face[1] || face[1] == face[2]) continue;  // degenerate
    bool seen = false;
    for (std::size_t j = 0; j < i; ++j) seen = seen || sorted(faces[j]) == face;
    expected += seen;
  }
  ASSERT_GT(expected, 50u);
  const Lint result = lint(soup_of(faces));
  EXPECT_EQ(found(result, Id::duplicate_faces).count, expected);
  EXPECT_EQ(found(result, Id::duplicate_faces).first.size(), LintFinding::shown);
}

TEST(Lint, FindsTransparentFacesByColour) {
  TriangleSoup soup = soup_of({plain, other});
  auto& rgba = std::get<FaceColors>(soup.appearance).rgba;
  rgba[0].a = 0.5f;  // visible: equal to the threshold
  rgba[1].a = std::nextafter(0.5f, 0.0f);
  EXPECT_THAT(found(lint(soup), Id::never_visible_faces).first, ElementsAre(1));
}

TEST(Lint, OneOpaqueVertexMakesAFaceVisible) {
  TriangleSoup soup = soup_of({plain, other});
  VertexColors colors{std::vector<glm::vec4>(6, glm::vec4(1, 1, 1, 0))};
  colors.rgba[5].a = 0.5f;
  soup.appearance = colors;
  EXPECT_THAT(found(lint(soup), Id::never_visible_faces).first, ElementsAre(0));
}

TEST(Lint, OneOpaqueTexelMakesAFaceVisible) {
  TriangleSoup soup = soup_of({plain, other});
  const std::uint32_t texels = lattice::texel_count(2);
  std::vector<std::uint8_t> bytes(2 * texels * LatticeTexture::channels, 255);
  for (std::uint32_t i = 0; i < 2 * texels; ++i)
    bytes[i * LatticeTexture::channels + LatticeTexture::features] = 127;  // just below one half
  bytes[(texels + 7) * LatticeTexture::channels + LatticeTexture::features] = 128;
  LatticeTexture texture;
  texture.patches = {{0, 2}, {texels, 2}};
  texture.texels = bytes;
  soup.appearance = texture;
  EXPECT_THAT(found(lint(soup), Id::never_visible_faces).first, ElementsAre(0));
}

TEST(Lint, AMaskThatNoTexelReachesHidesItsMaterial) {
  TriangleSoup soup = soup_of({plain, other});
  UvTextures textures;
  textures.uv.resize(6);
  textures.images.assign(2, Image8(2, 2, glm::u8vec4(255, 255, 255, 100)));
  textures.images[1].at(1, 1).a = 200;
  textures.materials.resize(2);
  for (std::uint32_t i = 0; i < 2; ++i) {
    textures.materials[i].images = {i};
    textures.materials[i].mask_threshold = 0.5f;
  }
  textures.material_of_face = {0, 1};
  soup.appearance = textures;
  EXPECT_THAT(found(lint(soup), Id::never_visible_faces).first, ElementsAre(0));
  // A threshold of zero draws everything.
  std::get<UvTextures>(soup.appearance).materials[0].mask_threshold = 0;
  EXPECT_EQ(found(lint(soup), Id::never_visible_faces).count, 0u);
}

TEST(Lint, CountsVerticesThatNoFaceNames) {
  TriangleSoup soup = soup_of({plain});
  soup.positions.resize(5);
  EXPECT_THAT(found(lint(soup), Id::unused_vertices).first, ElementsAre(3, 4));
}

TEST(Lint, WarnsOfASmallSoupFarFromItsOrigin) {
  auto far = plain;
  for (glm::vec3& corner : far) corner += glm::vec3(1e5f, 0, 0);
  const Lint result = lint(soup_of({far}));
  EXPECT_THAT(ids(result), ElementsAre(Id::far_from_origin));
  EXPECT_NEAR(result.extent_over_offset, std::sqrt(2.0) / 100001, 1e-9);
  for (glm::vec3& corner : far) corner -= glm::vec3(0.99e5f, 0, 0);
  EXPECT_THAT(lint(soup_of({far})).findings, IsEmpty());
}

TEST(Lint, FindingsInEnglish) {
  EXPECT_EQ(describe({.id = Id::never_visible_faces, .count = 1, .of = 2, .first = {1}}),
            "1 of 2 faces is transparent everywhere: face 1");
  EXPECT_EQ(describe({.id = Id::unused_vertices, .count = 6, .of = 9, .first = {0, 1, 2, 3, 4}}),
            "6 of 9 vertices are used by no face: vertices 0, 1, 2, 3, 4 ...");
  EXPECT_STREQ(name_of(Id::duplicate_faces), "duplicate_faces");
}

// -- splats

/// Spheres of radius 0.1 on a cube's grid, with harmonics of degree 1.
Splats grid_of_gaussians() {
  Splats splats;
  Gaussians gaussians;
  for (int i = 0; i < 27; ++i) {
    gaussians.centers.emplace_back(i % 3, i / 3 % 3, i / 9);
    gaussians.scales.emplace_back(0.1f);
    gaussians.rotations.emplace_back(1, 0, 0, 0);
    gaussians.opacity.push_back(0.5f);
    for (int k = 0; k < 4; ++k) splats.color.coefficients.emplace_back(0.1f);
  }
  splats.kernel = std::move(gaussians);
  splats.color.degree = 1;
  return splats;
}

Gaussians& gaussians_of(Splats& splats) { return std::get<Gaussians>(splats.kernel); }

TEST(Lint, CleanSplatsHaveNothingToSay) {
  EXPECT_THAT(lint(grid_of_gaussians()).findings, IsEmpty());
  EXPECT_THAT(lint(Splats{}).findings, IsEmpty());
  EXPECT_FALSE(is_transparent(grid_of_gaussians()));
  EXPECT_FALSE(is_transparent(Splats{}));
}

TEST(Lint, FindsSplatsThatAreTooTransparent) {
  Splats splats = grid_of_gaussians();
  gaussians_of(splats).opacity[4] = 0.0039f;  // 1/255 is 0.00392
  gaussians_of(splats).opacity[9] = 0;
  EXPECT_THAT(found(lint(splats), Id::transparent_splats).first, ElementsAre(4, 9));
  EXPECT_FALSE(is_transparent(splats));
  gaussians_of(splats).opacity.assign(27, 0.001f);
  EXPECT_TRUE(is_transparent(splats));
}

TEST(Lint, FindsNeedlesAndCollapsedSplats) {
  Splats splats = grid_of_gaussians();
  gaussians_of(splats).scales[2] = {0.5f, 0.0002f, 0.0002f};
  gaussians_of(splats).scales[5] = {0.5f, 0.1f, 0.0002f};  // a disc
  gaussians_of(splats).scales[6] = {0.1f, 0.1f, 0};
  Lint result = lint(splats);
  EXPECT_THAT(ids(result), ElementsAre(Id::collapsed_splats, Id::needle_splats));
  EXPECT_THAT(found(result, Id::needle_splats).first, ElementsAre(2));
  EXPECT_THAT(found(result, Id::collapsed_splats).first, ElementsAre(6));
  // The third scale of a flat one has no meaning.
  gaussians_of(splats).flat = true;
  result = lint(splats);
  EXPECT_THAT(ids(result), ElementsAre(Id::needle_splats));

  TriangleWindows windows{.corners = {{0, 0, 0},
                                      {1, 0, 0},
                                      {0, 1, 0},
                                      {0, 0, 0},
                                      {1, 0, 0},
                                      {0, 1e-4f, 0},
                                      {0, 0, 0},
                                      {1, 0, 0},
                                      {2, 0, 0}},
                          .sigma = {1, 1, 1},
                          .opacity = {1, 1, 1}};
  result = lint(Splats{.kernel = windows, .color = {.coefficients = {3, glm::vec3(1)}}});
  EXPECT_THAT(found(result, Id::needle_splats).first, ElementsAre(1));
  EXPECT_THAT(found(result, Id::collapsed_splats).first, ElementsAre(2));
}

TEST(Lint, FindsSplatsOutsideTheOthers) {
  Splats splats = grid_of_gaussians();
  gaussians_of(splats).centers[3] = {100, 1, 1};
  gaussians_of(splats).scales[8] = {0.1f, 0.1f, 50};
  EXPECT_THAT(found(lint(splats), Id::outlying_splats).first, ElementsAre(3, 8));
}

TEST(Lint, FindsRepeatedSplats) {
  Splats splats = grid_of_gaussians();
  for (const int i : {20, 11}) gaussians_of(splats).centers[i] = gaussians_of(splats).centers[5];
  EXPECT_THAT(found(lint(splats), Id::duplicate_splats).first, ElementsAre(11, 20));
  gaussians_of(splats).scales[11].y = 0.2f;
  EXPECT_THAT(found(lint(splats), Id::duplicate_splats).first, ElementsAre(20));
}

TEST(Lint, FindsHarmonicsThatAreZero) {
  Splats splats = grid_of_gaussians();
  for (std::size_t i = 0; i < splats.color.coefficients.size(); ++i)
    if (i % 4 > 0) splats.color.coefficients[i] = glm::vec3(0);
  const LintFinding zero = found(lint(splats), Id::zero_harmonics);
  EXPECT_THAT(zero.first, ElementsAre(1, 2, 3));
  EXPECT_EQ(zero.of, 4u);
  splats.color.coefficients[6].z = 1;
  EXPECT_EQ(lint(splats).find(Id::zero_harmonics), nullptr);
}

TEST(Lint, FindsSplatsFarFromTheOrigin) {
  Splats splats = grid_of_gaussians();
  for (glm::vec3& center : gaussians_of(splats).centers) center += glm::vec3(1e5f, 0, 0);
  EXPECT_THAT(ids(lint(splats)), ElementsAre(Id::far_from_origin));
}

}  // namespace lint_test
}  // namespace tureen
