// Mirrors and glass.
#include <gtest/gtest.h>

#include <cmath>

#include "oracle/light.hpp"
#include "tests/tracing/tracing_scenes.hpp"
#include "tracing/optics.hpp"
#include "tracing/traced_scene.hpp"

namespace tureen::test {
namespace materials_test {

/// The light along a ray over black, which the oracle must see, too.
glm::dvec3 light_along(const Scene& scene, const glm::dvec3& origin, const glm::dvec3& direction,
                       const glm::vec3& background = glm::vec3(0.0f)) {
  const tracing::TracedScene traced(scene, background, in_order);
  tracing::RayMemory memory;
  const tracing::Ray ray{origin, glm::normalize(direction)};
  const glm::dvec3 light = traced.light_along(ray, 1, 0, memory);
  const glm::dvec3 expected = oracle::Light(scene, background).along({ray.origin, ray.direction});
  EXPECT_LT(glm::distance(light, expected), 1e-6) << "tracing and the oracle agree";
  return light;
}

/// A plane y = -`depth` whose red is (x + 10) / 20.
Layer ruler(float depth) {
  const auto corner = [&](float x, float z) { return glm::vec3(x, -depth, z); };
  const auto color = [](float x) { return glm::vec4((x + 10) / 20, 0, 0, 1); };
  return layer_of(quad({corner(-10, -10), corner(10, -10), corner(10, 10), corner(-10, 10)},
                       {color(-10), color(10), color(10), color(-10)}));
}

/// A slab of glass between y = 0 and y = -thickness.
Layer slab(float thickness, float ior) {
  TriangleSoup soup = quad({{-9, 0, -9},
                            {-9, 0, 9},
                            {9, 0, 9},
                            {9, 0, -9},
                            {-9, -thickness, -9},
                            {9, -thickness, -9},
                            {9, -thickness, 9},
                            {-9, -thickness, 9}},
                           glm::vec3(1.0f));
  soup.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
  soup.appearance = FaceColors{std::vector<glm::vec4>(4, glm::vec4(1.0f))};
  return with(layer_of(soup), glass_material(ior));
}

TEST(Materials, ASlabMovesRaysByItsThicknessAndSnellsLaw) {
  for (const float ior : {1.33f, 1.5f, 2.4f})
    for (const double degrees : {5.0, 30.0, 60.0}) {
      Scene scene;
      scene.layers = {slab(1, ior), ruler(2)};
      const double in = degrees * M_PI / 180, out = std::asin(std::sin(in) / double(ior));
      const glm::dvec3 direction(std::sin(in), -std::cos(in), 0);
      const double part = tracing::at_boundary(direction, {0, 1, 0}, 1, double(ior)).reflectance;
      // From (0, 1): one unit of air above, one of glass, one of air below. Each two reflections
      // inside move the ray by twice the thickness times tan(out).
      double expected = 0;
      for (int bounces = 0; bounces < 8; ++bounces) {
        const double x = 2 * std::tan(in) + (1 + 2 * bounces) * std::tan(out);
        expected += (1 - part) * (1 - part) * std::pow(part, 2 * bounces) * (x + 10) / 20;
      }
      const double red = light_along(scene, {0, 1, 0}, direction).x;
      // Rays below 1/510 are cut: there are at most two of them.
      EXPECT_NEAR(red, expected, 2.0 / 510) << "index " << ior << ", " << degrees << " degrees";
      const double straight = (3 * std::tan(in) + 10) / 20;
      if (degrees > 20) {
        EXPECT_GT(std::abs(red - straight), 4.0 / 510) << "the test sees the offset";
      }
    }
}

TEST(Materials, FresnelAtKnownAngles) {
  const auto at = [](double degrees, double n1, double n2) {
    const double angle = degrees * M_PI / 180;
    return tracing::at_boundary({std::sin(angle), -std::cos(angle), 0}, {0, 1, 0}, n1, n2)
        .reflectance;
  };
  EXPECT_NEAR(at(0, 1, 1.5), 0.04, 1e-12);
  EXPECT_NEAR(at(0, 1.5, 1), 0.04, 1e-12);
  // At Brewster's angle, light with its field in the plane of incidence is not reflected.
  const double brewster = std::atan(1.5), other = M_PI / 2 - brewster;
  EXPECT_NEAR(at(brewster * 180 / M_PI, 1, 1.5),
              0.5 * std::pow(std::sin(brewster - other) / std::sin(brewster + other), 2), 1e-12);
  EXPECT_NEAR(at(89.9999, 1, 1.5), 1, 1e-4);
  EXPECT_EQ(at(37, 1, 1), 0);
}

TEST(Materials, BeyondTheCriticalAngleAllLightIsReflected) {
  // One boundary, seen from the glass below it: red above, blue below.
  Scene scene;
  TriangleSoup boundary = quad({{-9, 0, -9}, {-9, 0, 9}, {9, 0, 9}, {9, 0, -9}}, glm::vec3(1.0f));
  scene.layers = {
      with(layer_of(boundary), glass_material(1.5f)),
      layer_of(quad({{-99, 1, -99}, {99, 1, -99}, {99, 1, 99}, {-99, 1, 99}}, {1, 0, 0})),
      layer_of(quad({{-99, -2, -99}, {99, -2, -99}, {99, -2, 99}, {-99, -2, 99}}, {0, 0, 1}))};
  const double critical = std::asin(1 / 1.5);
  for (const double beyond : {-0.02, -1e-4, 1e-4, 0.02}) {
    const double angle = critical + beyond;
    const glm::dvec3 light = light_along(scene, {0, -1, 0}, {std::sin(angle), std::cos(angle), 0});
    if (beyond > 0) {
      EXPECT_EQ(light, glm::dvec3(0, 0, 1));
    } else {
      EXPECT_GT(light.r, beyond < -0.01 ? 0.5 : 0.05);
    }
    EXPECT_NEAR(light.r + light.b, 1, 1e-9);
  }
}

TEST(Materials, AMirrorInAMirror) {
  // Two mirrors at y = 0 and y = 1 up to x = `length`, a red wall behind their end. A ray at 45
  // degrees meets them at x = 0.1, 1.1, ..
  for (int bounces = 1; bounces <= 8; ++bounces) {
    const float length = float(bounces) - 0.4f;
    Material mirror = mirror_material();
    mirror.base_color = {0.9f, 0.5f, 0.9f};
    Scene scene;
    for (const float y : {0.0f, 1.0f})
      scene.layers.push_back(with(
          layer_of(quad({{-1, y, -1}, {-1, y, 1}, {length, y, 1}, {length, y, -1}}, glm::vec3(1))),
          mirror));
    scene.layers.push_back(layer_of(
        quad({{9.5f, -99, -99}, {9.5f, 99, -99}, {9.5f, 99, 99}, {9.5f, -99, 99}}, glm::vec3(1))));
    const double weight = std::pow(0.9, bounces);
    const glm::dvec3 light = light_along(scene, {-0.5, 0.4, 0.3}, {1, 1, 0});
    EXPECT_NEAR(light.r, weight, 1e-6) << bounces;
    EXPECT_NEAR(light.g, std::pow(0.5, bounces), 1e-6) << bounces;
  }
  // The ninth reflection has the colour of the background.
  Scene scene;
  for (const float y : {0.0f, 1.0f})
    scene.layers.push_back(
        with(layer_of(quad({{-1, y, -1}, {-1, y, 1}, {99, y, 1}, {99, y, -1}}, glm::vec3(1))),
             mirror_material()));
  EXPECT_EQ(light_along(scene, {-0.5, 0.4, 0.3}, {1, 1, 0}, {0, 1, 0}), glm::dvec3(0, 1, 0));
}

TEST(Materials, TheDiagonalOfAMirrorReflectsOnce) {
  Scene scene;
  scene.layers = {
      with(layer_of(quad({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, glm::vec3(1)),
                    glm::translate(glm::dmat4(1.0), glm::dvec3(1e6, 0, 0))),
           mirror_material()),
      layer_of(quad({{-9, -9, 3}, {9, -9, 3}, {9, 9, 3}, {-9, 9, 3}}, {1, 0, 0}),
               glm::translate(glm::dmat4(1.0), glm::dvec3(1e6, 0, 0)))};
  for (int i = -9; i <= 9; ++i)
    EXPECT_EQ(light_along(scene, {1e6, 0, 2}, {0.1 * i, 0.1 * i, -2}), glm::dvec3(1, 0, 0));
}

/// In uniform light, mirrors without colour and clear glass cannot be seen.
TEST(Materials, BallsVanishInAUniformBackground) {
  const glm::vec3 background(0.3f, 0.6f, 0.9f);
  Random random(31);
  Scene scene;
  scene.layers = {with(layer_of(unit_ball(3)), mirror_material()),
                  with(layer_of(unit_ball(3), ball_at({2.5, 0, 0}, 1)), glass_material(1.5f)),
                  with(layer_of(unit_ball(2), ball_at({1, 2, 0.3}, 0.7)), glass_material(2.4f))};
  std::get<TriangleSoup>(scene.layers[2].primitives).normals.clear();  // flat faces
  const tracing::TracedScene traced(scene, background, in_order);
  tracing::RayMemory memory;
  int met = 0;
  for (int i = 0; i < 3000; ++i) {
    const glm::dvec3 from = 6.0 * random.direction();
    const glm::dvec3 to = glm::dvec3(1.2, 0.7, 0) + 1.5 * random.direction();
    const tracing::Ray ray{from, glm::normalize(to - from)};
    met += traced.surface_on(ray).exists();
    const glm::dvec3 light = traced.light_along(ray, 1, 0, memory);
    EXPECT_LT(glm::distance(light, glm::dvec3(background)), 1e-9);
  }
  EXPECT_GT(met, 1000);
}

TEST(Materials, ColorOfGlassTintsWhatPasses) {
  Scene scene;
  Layer glass = slab(1, 1.0f);
  glass.material->base_color = {1.0f, 0.5f, 0.25f};
  scene.layers = {glass, ruler(2)};
  scene.layers[1].primitives =
      quad({{-9, -2, -9}, {9, -2, -9}, {9, -2, 9}, {-9, -2, 9}}, glm::vec3(1.0f));
  const glm::dvec3 light = light_along(scene, {0, 1, 0}, {0.1, -1, 0});
  EXPECT_LT(glm::distance(light, glm::dvec3(1, 0.25, 0.0625)), 1e-6);
}

}  // namespace materials_test
}  // namespace tureen::test
