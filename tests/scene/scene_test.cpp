#include "scene/scene.hpp"

#include <gmock/gmock.h>

#include <glm/gtc/matrix_transform.hpp>
#include <limits>

#include "base/error.hpp"
#include "formats/diffsoup/diffsoup_remarks.hpp"
#include "formats/splat/splat_remarks.hpp"
#include "scene/opaque_windows.hpp"

namespace tureen {
namespace scene_test {

using testing::HasSubstr;

Layer layer_with(const glm::dmat4& world_from_layer) {
  return {.world_from_layer = world_from_layer};
}

/// A rotation by 1 rad about a slanted axis.
glm::dmat4 rotation() { return glm::rotate(glm::dmat4(1), 1.0, glm::dvec3(0.2, -0.5, 0.7)); }

TriangleSoup triangle() {
  return {.positions = {{0, 0, 0}, {1, 0, 0}, {0, 2, 3}},
          .triangles = {{0, 1, 2}},
          .appearance = FaceColors{{glm::vec4(1)}}};
}

Splats window() {
  return {.kernel =
              TriangleWindows{
                  .corners = {{0, 0, 0}, {1, 0, 0}, {0, 2, 3}}, .sigma = {1}, .opacity = {0.5f}},
          .color = {.coefficients = {glm::vec3(0)}}};
}

TEST(Scene, AChosenProfileAppliesToEveryLayerOfSplats) {
  Scene scene = scene_of(Splats{.kernel = Gaussians{}, .profile = *profile_named("3dgs")});
  scene.layers.push_back({.primitives = triangle()});
  Gaussians flat;
  flat.flat = true;
  scene.layers.push_back({.primitives = Splats{.kernel = flat}});
  scene.info.remarks = {{&remarks::profile_assumed, {{"profile", "2dgs"}}},
                        {&remarks::level_missing}};
  choose_profile(scene, "mip");
  for (const std::size_t i : {0, 2})
    EXPECT_EQ(std::get<Splats>(scene.layers[i].primitives).profile, *profile_named("mip"));
  ASSERT_EQ(scene.info.remarks.size(), 1u);
  EXPECT_EQ(scene.info.remarks[0].kind, &remarks::level_missing);

  EXPECT_THROW(choose_profile(scene, "2dgs"), UsageError);  // the first layer is not flat
  scene.layers = {{.primitives = triangle()}};
  EXPECT_THROW(choose_profile(scene, "mip"), UsageError);
}

TEST(Scene, AChosenUpAxisRemovesTheRemarkThatItWasAssumed) {
  SceneInfo info;
  info.up_is_assumed = true;
  info.remarks = {{&remarks::up_unknown_to_splats, {{"format", "PLY"}}}};
  choose_up(info, {0, 0, 1});
  EXPECT_FALSE(info.up_is_assumed);
  EXPECT_TRUE(info.remarks.empty());
}

TEST(Layer, SimilaritiesHaveNoDefect) {
  EXPECT_EQ(defect(Layer{}), std::nullopt);
  EXPECT_EQ(defect(layer_with(at_origin({1e9, -2, 0.1}))), std::nullopt);
  const glm::dmat4 mirror = glm::scale(glm::dmat4(1), glm::dvec3(1, 1, -1));
  for (const double scale : {1.0, 1e-12, 1e12, 1e-200, 1e200, 1e-310, -3.0})
    for (const glm::dmat4& handed : {glm::dmat4(1), mirror}) {
      const glm::dmat4 linear = rotation() * glm::scale(glm::dmat4(1), glm::dvec3(scale)) * handed;
      EXPECT_EQ(defect(layer_with(at_origin({1, 2, 3}) * linear)), std::nullopt) << scale;
    }
}

TEST(Layer, SinglePrecisionIsNoDefect) {
  const glm::mat4 turn(rotation()), scale = glm::scale(glm::mat4(1), glm::vec3(0.1f));
  glm::mat4 product(1);
  for (int i = 0; i < 10; ++i) product = scale * (turn * product);
  EXPECT_EQ(defect(layer_with(glm::dmat4(product))), std::nullopt);
}

TEST(Layer, OtherTransformsHaveADefect) {
  const auto defect_of = [](const glm::dmat4& world_from_layer) {
    return defect(layer_with(world_from_layer)).value_or("");
  };
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    for (int column = 0; column < 4; ++column)
      for (int row = 0; row < 4; ++row) {
        glm::dmat4 matrix(1);
        matrix[column][row] = bad;
        EXPECT_THAT(defect_of(matrix), HasSubstr("not finite")) << column << ", " << row;
      }
  for (int column = 0; column < 4; ++column) {
    glm::dmat4 perspective(1);
    perspective[column][3] += 1e-9;
    EXPECT_THAT(defect_of(perspective), HasSubstr("last row")) << column;
  }
  glm::dmat4 zero(0);
  zero[3] = {1, 2, 3, 1};
  EXPECT_THAT(defect_of(zero), HasSubstr("zero"));
  // Just beyond the tolerance, and far beyond it.
  for (const double by : {1e-4, 1.0}) {
    const glm::dmat4 stretch = glm::scale(glm::dmat4(1), glm::dvec3(1, 1 + by, 1));
    EXPECT_THAT(defect_of(rotation() * stretch), HasSubstr("stretches")) << by;
    glm::dmat4 shear(1);
    shear[1][0] = by;
    EXPECT_THAT(defect_of(rotation() * shear), HasSubstr("shears")) << by;
  }
  const glm::dmat4 flat = glm::scale(glm::dmat4(1), glm::dvec3(1, 1, 0));
  EXPECT_THAT(defect_of(flat), HasSubstr("stretches"));
}

TEST(Layer, ItsOriginIsItsTranslation) {
  const glm::dvec3 origin(1e6 + 1.0 / 3, -0.1, 1e-300);
  EXPECT_EQ(origin_of(layer_with(at_origin(origin))), origin);
  EXPECT_EQ(origin_of(layer_with(at_origin(origin) * rotation())), origin);
  EXPECT_EQ(origin_of(Layer{}), glm::dvec3(0));
}

TEST(Layer, TheBoundsOfWindowsAreThoseOfTheirCorners) {
  for (const Layer& layer :
       {scene_of(triangle(), {1, 2, 3}).layers[0], scene_of(window(), {1, 2, 3}).layers[0]}) {
    EXPECT_EQ(bounds(layer).low, glm::vec3(0, 0, 0));
    EXPECT_EQ(bounds(layer).high, glm::vec3(1, 2, 3));
  }
}

TEST(Layer, AMaterialOutsideItsRangeIsADefect) {
  Layer layer{.material = glass_material(1.5f)};
  EXPECT_EQ(defect(layer), std::nullopt);
  EXPECT_TRUE(is_glass(*layer.material));
  EXPECT_FALSE(is_mirror(*layer.material));
  EXPECT_TRUE(is_mirror(mirror_material()));
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  for (const Material& wrong :
       {Material{.base_color = {1, 1.01f, 1}}, Material{.metallic = -0.1f},
        Material{.roughness = 2}, Material{.transmission = nan}, Material{.ior = 0.99f},
        Material{.ior = nan}, Material{.ior = std::numeric_limits<float>::infinity()}})
    EXPECT_NE(defect(Layer{.material = wrong}), std::nullopt);
}

TEST(Soup, NormalsHaveLengthOneOrZeroAndAreAllOrNone) {
  TriangleSoup soup = triangle();
  const std::size_t bytes = byte_size(soup);
  soup.normals = {{0, 0, 1}, {0.6f, 0.8f, 0}, {0, 0, 0}};
  EXPECT_EQ(defect(soup), std::nullopt);
  EXPECT_EQ(byte_size(soup), bytes + 3 * sizeof(glm::vec3));
  for (const glm::vec3& wrong : {glm::vec3(0.6f, 0.8f, 0.01f), glm::vec3(1e-20f, 0, 0),
                                 glm::vec3(std::numeric_limits<float>::quiet_NaN(), 0, 0)}) {
    soup.normals[1] = wrong;
    EXPECT_NE(defect(soup), std::nullopt);
  }
  soup.normals.pop_back();
  EXPECT_NE(defect(soup), std::nullopt);
}

TEST(Scene, OfOneSoupHasOneLayer) {
  Scene scene = scene_of(triangle(), {1, 2, 3});
  EXPECT_EQ(scene.layers.size(), 1u);
  EXPECT_EQ(&only_layer(scene), &scene.layers[0]);
  EXPECT_EQ(&only_soup(scene), &std::get<TriangleSoup>(scene.layers[0].primitives));
  EXPECT_TRUE(only_layer(scene).visible);
  EXPECT_EQ(origin_of(only_layer(scene)), glm::dvec3(1, 2, 3));
}

TEST(Scene, OfSeveralLayersHasNoOnlyLayer) {
  Scene scene;
  const auto refusal = [&]() -> std::string {
    try {
      only_layer(scene);
    } catch (const UsageError& error) {
      return error.reason();
    }
    return "";
  };
  EXPECT_EQ(refusal(), "only a scene with one layer is supported here; this scene has no layer");
  scene.layers = {{.name = "house"}, {}, {.name = "garden"}};
  EXPECT_EQ(
      refusal(),
      "only a scene with one layer is supported here; this scene has 3: house, layer 2, garden");
  EXPECT_THROW(only_soup(scene), UsageError);
}

TEST(Scene, OnlyTriangleWindowsBecomeOpaque) {
  Scene scene = scene_of(triangle());
  scene.layers.push_back({.name = "cloud", .primitives = Splats{.kernel = Gaussians{}}});
  try {
    make_opaque(scene);
    ADD_FAILURE();
  } catch (const UsageError& error) {
    EXPECT_EQ(error.reason(),
              "only triangle windows become opaque triangles; cloud holds Gaussians");
  }
}

TEST(Scene, EveryLayerOfWindowsBecomesOpaque) {
  Scene scene = scene_of(window());
  scene.layers.push_back({.primitives = triangle()});
  scene.layers.push_back({.primitives = window()});
  make_opaque(scene);
  ASSERT_EQ(scene.layers.size(), 3u);
  for (const Layer& layer : scene.layers)
    EXPECT_EQ(std::get<TriangleSoup>(layer.primitives).triangles.size(), 1u);
  EXPECT_TRUE(std::holds_alternative<FaceColors>(
      std::get<TriangleSoup>(scene.layers[1].primitives).appearance));
  EXPECT_EQ(scene.info.remarks.size(), 2 * to_opaque(window()).remarks.size());
}

}  // namespace scene_test
}  // namespace tureen
