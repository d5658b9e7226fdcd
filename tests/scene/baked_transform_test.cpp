// A layer's rotation, scale and mirror in its vertices.
#include "scene/edit/baked_transform.hpp"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "base/error.hpp"

namespace tureen {
namespace baked_transform_test {

Harmonics harmonics_of(int degree) {
  Harmonics sh;
  sh.degree = degree;
  return sh;
}

/// A lattice texture or UV textures.
template <class Texture>
Texture with_network(DirectionEncoding encoding) {
  Texture texture;
  texture.mlp.emplace().encoding = encoding;
  return texture;
}

Layer layer_of(Appearance appearance) {
  const glm::dmat4 linear =
      glm::scale(glm::rotate(glm::dmat4(1), 1.0, glm::dvec3(0.2, -0.5, 0.7)), glm::dvec3(2, 2, -2));
  return {.world_from_layer = at_origin({1e6, 2, 3}) * linear,
          .primitives = TriangleSoup{.positions = {{0, 0, 0}, {1, 0, 0}, {0, 2, 3}},
                                     .triangles = {{0, 1, 2}},
                                     .appearance = std::move(appearance)}};
}

TEST(BakedTransform, KeepsVerticesWhereTheyAre) {
  Layer layer = layer_of(FaceColors{{glm::vec4(1)}});
  ASSERT_FALSE(is_translation(layer));
  const Layer before = layer;
  bake_transform(layer);
  EXPECT_TRUE(is_translation(layer));
  EXPECT_EQ(origin_of(layer), origin_of(before));
  const auto& baked = std::get<TriangleSoup>(layer.primitives).positions;
  const auto& own = std::get<TriangleSoup>(before.primitives).positions;
  for (std::size_t i = 0; i < own.size(); ++i) {
    const glm::dvec3 expected(before.world_from_layer * glm::dvec4(own[i], 1.0));
    for (int k = 0; k < 3; ++k)
      // A coordinate of at most 8, rounded to float: 2^-22. The world's million has 2^-34.
      EXPECT_NEAR(origin_of(layer)[k] + double(baked[i][k]), expected[k], 2.5e-7);
  }
}

TEST(BakedTransform, TurnsNormalsWithTheSurface) {
  Layer layer = layer_of(FaceColors{{glm::vec4(1)}});
  auto& soup = std::get<TriangleSoup>(layer.primitives);
  const auto normal_of = [&] {
    const auto& p = soup.positions;
    return glm::normalize(glm::cross(p[1] - p[0], p[2] - p[0]));
  };
  const glm::vec3 own = normal_of();
  soup.normals = {own, glm::vec3(0), -own};
  bake_transform(layer);
  // The corners of a mirrored face turn the other way round; the normal stays on its side.
  const glm::vec3 expected = -normal_of();
  EXPECT_LT(glm::distance(soup.normals[0], expected), 1e-6f);  // rounding of positions near 8
  EXPECT_EQ(soup.normals[1], glm::vec3(0));
  EXPECT_EQ(soup.normals[2], -soup.normals[0]);
  EXPECT_EQ(defect(soup), std::nullopt);
}

TEST(BakedTransform, ATranslationChangesNothing) {
  Layer layer = layer_of(harmonics_of(2));
  layer.world_from_layer = at_origin({1e6, 2, 3});
  const auto before = std::get<TriangleSoup>(layer.primitives).positions;
  bake_transform(layer);
  EXPECT_EQ(std::get<TriangleSoup>(layer.primitives).positions, before);
}

TEST(BakedTransform, LengthsOfTheProfileAreScaled) {
  Layer layer;
  layer.world_from_layer = glm::scale(glm::dmat4(1), glm::dvec3(2));
  layer.primitives = Splats{.profile = {.min_center_depth = 0.25f}};
  bake_transform(layer);
  EXPECT_FLOAT_EQ(std::get<Splats>(layer.primitives).profile.min_center_depth, 0.5f);
}

TEST(BakedTransform, ColoursThatDependOnTheViewAreRefused) {
  for (Layer layer : {layer_of(harmonics_of(1)),
                      layer_of(with_network<LatticeTexture>(DirectionEncoding::harmonics2)),
                      layer_of(with_network<UvTextures>(DirectionEncoding::xyz))}) {
    EXPECT_TRUE(depends_on_view(layer));
    EXPECT_THROW(bake_transform(layer), UsageError);
  }
  for (Layer layer : {layer_of(harmonics_of(0)), layer_of(LatticeTexture()),
                      layer_of(with_network<LatticeTexture>(DirectionEncoding::none)),
                      layer_of(VertexColors())}) {
    EXPECT_FALSE(depends_on_view(layer));
    EXPECT_NO_THROW(bake_transform(layer));
  }
}

}  // namespace baked_transform_test
}  // namespace tureen
