#include "scene/edit/edits.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "scene/edit/baked_color.hpp"
#include "scene/edit/keep_faces.hpp"
#include "scene/edit/lattice_bytes.hpp"
#include "scene/edit/lattice_levels.hpp"
#include "scene/edit/mean_color.hpp"
#include "scene/edit/moved_normals.hpp"
#include "tests/support/random_soups.hpp"

namespace tureen {
namespace edits_test {

constexpr unsigned seed = 2611;

/// Five faces of levels 0 to 4 in floats, with a network of all features.
TriangleSoup random_lattice_soup() {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  TriangleSoup soup;
  LatticeTexture texture;
  std::uint32_t texels = 0;
  for (std::uint32_t face = 0; face < 5; ++face) {
    for (int k = 0; k < 3; ++k)
      soup.positions.emplace_back(unit(random), unit(random), unit(random));
    soup.triangles.emplace_back(3 * face, 3 * face + 1, 3 * face + 2);
    texture.patches.push_back({texels, face});
    texels += lattice::texel_count(int(face));
  }
  std::vector<float> values(std::size_t(texels) * LatticeTexture::channels);
  for (float& value : values) value = unit(random);
  texture.texels = values;
  ColorMlp mlp;
  mlp.encoding = DirectionEncoding::none;
  DenseLayer layer{LatticeTexture::features, 3, {}, {0.1f, 0.2f, 0.3f}};
  for (int i = 0; i < 3 * LatticeTexture::features; ++i) layer.weights.push_back(unit(random));
  mlp.layers = {layer};
  texture.mlp = mlp;
  soup.appearance = texture;
  return soup;
}

const LatticeTexture& texture_of(const TriangleSoup& soup) {
  return std::get<LatticeTexture>(soup.appearance);
}

/// Every kind of edit, for random_lattice_soup().
Edits all_edits() {
  return {.keeps_face = {0, 1, 1, 1, 1},
          .lattice_level = 2,
          .color = Edits::Color::baked,
          .byte_texels = true};
}

TEST(Edits, NoneChangeNothing) {
  const TriangleSoup soup = random_lattice_soup();
  const TriangleSoup same = edited(soup, {});
  EXPECT_EQ(same.positions, soup.positions);
  EXPECT_EQ(same.triangles, soup.triangles);
  EXPECT_EQ(texture_of(same).texels, texture_of(soup).texels);
  EXPECT_TRUE(texture_of(same).mlp);
  EXPECT_EQ(describe(Edits{}), "none");
}

TEST(Edits, EachIsWhatItsFunctionMakes) {
  const TriangleSoup soup = random_lattice_soup();
  const LatticeTexture& texture = texture_of(soup);
  EXPECT_EQ(texture_of(edited(soup, {.lattice_level = 2})).texels,
            at_most_level(texture, 2).texels);
  EXPECT_EQ(texture_of(edited(soup, {.color = Edits::Color::baked})).texels,
            baked_color(texture).texels);
  EXPECT_FALSE(texture_of(edited(soup, {.color = Edits::Color::base})).mlp);
  LatticeTexture bytes = texture;
  round_to_bytes(bytes);
  EXPECT_EQ(texture_of(edited(soup, {.byte_texels = true})).texels, bytes.texels);
  const std::vector<std::uint8_t> keeps{1, 0, 1, 0, 0};
  const TriangleSoup fewer = edited(soup, {.keeps_face = keeps});
  EXPECT_EQ(fewer.triangles, keep_faces(soup, keeps).triangles);
  EXPECT_EQ(texture_of(fewer).texels, texture_of(keep_faces(soup, keeps)).texels);
}

// Of every appearance, each face keeps its corners, its colours and its normals.
TEST(Edits, KeptFacesKeepTheirData) {
  for (const test::Kind kind : test::all_kinds)
    for (const bool shared : {false, true}) {
      SCOPED_TRACE(test::to_string(kind) + (shared ? ", shared" : ""));
      TriangleSoup soup =
          test::random_soup(3, {.kind = kind, .faces = 20, .shared_vertices = shared, .level = 1});
      for (const glm::vec3& p : soup.positions)
        soup.normals.push_back(unit_or_zero(glm::dvec3(p.y, p.z, p.x)));
      std::vector<std::uint8_t> keeps(20, 0);
      keeps[3] = keeps[4] = keeps[19] = 1;
      const TriangleSoup kept = keep_faces(soup, keeps);
      ASSERT_EQ(defect(kept), std::nullopt);
      ASSERT_EQ(kept.triangles.size(), 3u);
      EXPECT_LE(kept.positions.size(), 9u);
      EXPECT_LT(byte_size(kept), byte_size(soup));
      const std::size_t faces[] = {3, 4, 19};
      for (std::size_t t = 0; t < 3; ++t)
        for (int k = 0; k < 3; ++k) {
          const std::uint32_t before = soup.triangles[faces[t]][k], after = kept.triangles[t][k];
          EXPECT_EQ(kept.positions[after], soup.positions[before]);
          EXPECT_EQ(kept.normals[after], soup.normals[before]);
          if (const auto* textures = std::get_if<UvTextures>(&kept.appearance)) {
            const auto& all = std::get<UvTextures>(soup.appearance);
            EXPECT_EQ(textures->uv[after], all.uv[before]);
            EXPECT_EQ(textures->material_of_face[t], all.material_of_face[faces[t]]);
          }
        }
      const auto means = mean_colors(soup), kept_means = mean_colors(kept);
      for (std::size_t t = 0; t < 3; ++t) EXPECT_EQ(kept_means[t], means[faces[t]]);
    }
}

TEST(Edits, ComeOneAfterTheOther) {
  const TriangleSoup soup = random_lattice_soup();
  const Edits all = all_edits();
  const TriangleSoup result = edited(soup, all);
  ASSERT_EQ(defect(result), std::nullopt);
  EXPECT_EQ(result.triangles.size(), 4u);
  EXPECT_FALSE(texture_of(result).is_float());
  EXPECT_FALSE(texture_of(result).mlp);
  for (const LatticePatch& patch : texture_of(result).patches) EXPECT_LE(patch.level, 2u);
  LatticeTexture expected =
      baked_color(at_most_level(texture_of(keep_faces(soup, all.keeps_face)), 2));
  round_to_bytes(expected);
  EXPECT_EQ(texture_of(result).texels, expected.texels);
}

TEST(Edits, WhatChangesNothingIsNotEffective) {
  const TriangleSoup soup = random_lattice_soup();
  const Edits all = all_edits();
  EXPECT_EQ(effective(all, soup), all);
  EXPECT_EQ(effective({.keeps_face = {1, 1, 1, 1, 1}, .lattice_level = 4}, soup), Edits{});
  Edits again = all;
  again.keeps_face.clear();
  EXPECT_EQ(effective(again, edited(soup, all)), Edits{});
  TriangleSoup flat = soup;
  flat.appearance = FaceColors{std::vector<glm::vec4>(5, glm::vec4(0.5f))};
  EXPECT_EQ(effective(again, flat), Edits{});
}

TEST(Edits, OtherAppearancesLoseFacesAlone) {
  TriangleSoup soup = random_lattice_soup();
  soup.appearance = FaceColors{std::vector<glm::vec4>(5, glm::vec4(0.5f))};
  const TriangleSoup result = edited(
      soup, {.keeps_face = {1, 1, 0, 0, 0}, .lattice_level = 0, .color = Edits::Color::base});
  EXPECT_EQ(std::get<FaceColors>(result.appearance).rgba.size(), 2u);
}

TEST(Edits, WhatMakesNoSenseHasADefect) {
  const TriangleSoup soup = random_lattice_soup();
  EXPECT_EQ(defect(Edits{}, soup), std::nullopt);
  EXPECT_EQ(defect({.keeps_face = {1, 0, 0, 0, 0}}, soup), std::nullopt);
  EXPECT_TRUE(defect({.keeps_face = {1, 0}}, soup));
  EXPECT_TRUE(defect({.keeps_face = {0, 0, 0, 0, 0}}, soup));
  EXPECT_TRUE(defect({.lattice_level = 8}, soup));
  EXPECT_TRUE(defect({.lattice_level = -1}, soup));
}

}  // namespace edits_test
}  // namespace tureen
