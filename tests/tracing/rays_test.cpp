// Rays of any origin against the oracle, which tests every primitive in double precision.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "oracle/light.hpp"
#include "tests/support/random_soups.hpp"
#include "tests/support/random_splats.hpp"
#include "tests/tracing/tracing_scenes.hpp"
#include "tracing/traced_scene.hpp"

namespace tureen::test {
namespace rays_test {

constexpr glm::vec3 background(0.2f, 0.4f, 0.6f);

struct Place {
  const char* name;
  glm::dmat4 world_from_layer;
};

std::vector<Place> places() {
  const glm::dmat4 turned = glm::rotate(glm::dmat4(1.0), 1.1, glm::dvec3(0.6, 0, 0.8));
  return {{"as stored", glm::dmat4(1.0)},
          {"units of 1e-4", glm::scale(turned, glm::dvec3(1e-4))},
          {"units of 1e4", glm::scale(turned, glm::dvec3(1e4))},
          {"offset of 1e6", glm::translate(glm::dmat4(1.0), glm::dvec3(1e6, -1e6, 5e5)) * turned},
          {"mirrored", glm::scale(turned, glm::dvec3(-2, 2, 2))}};
}

/// A ray that passes the unit ball of the layer, from outside or inside.
tracing::Ray random_ray(Random& random, const glm::dmat4& world_from_layer, double reach = 2.5) {
  const glm::dvec3 from = reach * std::cbrt(random.uniform()) * random.direction();
  const glm::dvec3 to = 0.8 * std::cbrt(random.uniform()) * random.direction();
  const double scale = glm::length(glm::dvec3(world_from_layer[0]));
  return {glm::dvec3(world_from_layer * glm::dvec4(from, 1)),
          glm::normalize(glm::dvec3(world_from_layer * glm::dvec4(to - from, 0))),
          scale * random.uniform(0, 2), 0.002};
}

/// Compares `count` rays; expects 99.9 % within 1/255, and that most see something.
void compare(const Scene& scene, const std::string& what, int count, double reach = 2.5,
             const std::function<void(tracing::Ray&)>& change = {}, double contrast = 0.1) {
  const tracing::TracedScene traced(scene, background, in_order);
  const oracle::Light light(scene, background);
  Random random(7);
  tracing::RayMemory kept;
  int wrong = 0, seen = 0;
  double largest = 0;
  for (int i = 0; i < count; ++i) {
    tracing::Ray ray = random_ray(random, scene.layers[0].world_from_layer, reach);
    if (change) change(ray);
    const glm::dvec3 expected = light.along({ray.origin, ray.direction, ray.path, ray.pixel});
    tracing::RayMemory fresh;
    const glm::dvec3 actual = traced.light_along(ray, 1, 0, kept);
    EXPECT_EQ(actual, traced.light_along(ray, 1, 0, fresh))
        << what << ": the intervals in which splats are collected change nothing";
    double error = 0;
    for (int c = 0; c < 3; ++c)
      error = std::max(
          error, std::abs(std::clamp(actual[c], 0.0, 1.0) - std::clamp(expected[c], 0.0, 1.0)));
    wrong += !(error <= 1.0 / 255);
    seen += glm::distance(expected, glm::dvec3(background)) > contrast;
    largest = std::max(largest, error);
  }
  EXPECT_LE(wrong, count / 1000) << what << ": largest error " << 255 * largest << "/255";
  EXPECT_GE(seen, count / 2) << what;
}

class RaysThrough : public testing::TestWithParam<SplatKind> {};

TEST_P(RaysThrough, SplatsAgreeWithTheOracle) {
  for (const Place& place : places()) {
    Scene scene;
    scene.layers.push_back(
        layer_of(random_splats(GetParam(), 400, 0.25, 11), place.world_from_layer));
    compare(scene, place.name, 1000);
  }
}

TEST_P(RaysThrough, ThreeCoincidentCopiesInTwoLayers) {
  const Splats once = random_splats(GetParam(), 60, 0.4, 12);
  Scene scene;
  scene.layers.assign(3, layer_of(once));
  compare(scene, "three layers", 1000);
  // Three copies of a splat in one layer, and once more in another.
  Splats thrice = once;
  for (int copy = 0; copy < 2; ++copy) {
    for_each_column(once.kernel, [&](const auto& from) {
      for_each_column(thrice.kernel, [&](const auto& to) {
        if constexpr (std::is_same_v<std::remove_cvref_t<decltype(from.values)>,
                                     std::remove_cvref_t<decltype(to.values)>>)
          if (std::string_view(from.name) == to.name)
            to.values.insert(to.values.end(), from.values.begin(), from.values.end());
      });
    });
    thrice.color.coefficients.insert(thrice.color.coefficients.end(),
                                     once.color.coefficients.begin(),
                                     once.color.coefficients.end());
  }
  ASSERT_EQ(count(thrice), 3 * count(once));
  scene.layers = {layer_of(thrice), layer_of(once)};
  compare(scene, "three copies", 1000);
}

/// Without the growth of boxes by the footprint, nearly all of these rays miss.
TEST_P(RaysThrough, SmallSplatsHaveTheFootprintOfAPixel) {
  Scene scene;
  scene.layers.push_back(layer_of(random_splats(GetParam(), 300, 0.003, 13)));
  const auto& splats = std::get<Splats>(scene.layers[0].primitives);
  const SplatProfile::LowPass low_pass = splats.profile.low_pass;
  Random random(14);
  compare(
      scene, "small", 1000, 2.5,
      [&](tracing::Ray& ray) {
        // A pixel is up to 0.1 wide: about 20 splats. Mip-Splatting makes them as transparent.
        ray.pixel = low_pass == SplatProfile::LowPass::none  ? 0.0
                    : low_pass == SplatProfile::LowPass::mip ? 0.002
                                                             : 0.04;
        const glm::dvec3 target = center(splats, random.below(300));
        const double aside = ray.pixel * glm::distance(target, ray.origin);
        ray.direction = glm::normalize(target - ray.origin + 0.6 * aside * random.direction());
      },
      low_pass == SplatProfile::LowPass::mip ? 0.01 : 0.1);
}

TEST_P(RaysThrough, RefittedLayersAreRebuiltOnes) {
  Scene scene;
  scene.layers.push_back(layer_of(random_splats(GetParam(), 500, 0.25, 15)));
  tracing::TracedScene refitted(scene, background, in_order);
  const tracing::Node* const nodes = refitted.layer(0).bvh().nodes().data();
  Random random(16);
  auto& splats = std::get<Splats>(scene.layers[0].primitives);
  for_each_column(splats.kernel, [&](const auto& column) {
    if constexpr (std::is_same_v<decltype(column.values), std::vector<glm::vec3>&>)
      if (column.role == ColumnRole::position || column.role == ColumnRole::corner)
        for (std::size_t i = 0; i < column.values.size(); i += column.per_splat) {
          const glm::vec3 step(0.2 * random.direction());
          for (std::size_t k = 0; k < column.per_splat; ++k) column.values[i + k] += step;
        }
  });
  scene.layers[0].world_from_layer = places()[1].world_from_layer;
  std::vector<DocumentLayer> layers = tracing::layers_for_rays(scene);
  // Other primitives of the same layer. They move so little that the tree stays.
  layers[0].primitives = std::make_shared<const Primitives>(scene.layers[0].primitives);
  refitted.sync(layers, in_order);
  EXPECT_EQ(refitted.layer(0).bvh().nodes().data(), nodes);
  EXPECT_FALSE(refitted.layer(0).was_rebuilt());
  const tracing::TracedScene rebuilt(scene, background, in_order);
  tracing::RayMemory memory;
  for (int i = 0; i < 1000; ++i) {
    const tracing::Ray ray = random_ray(random, scene.layers[0].world_from_layer);
    // The tree decides which boxes limit distances, whose last bits order the splats: at rounding.
    const glm::dvec3 a = refitted.light_along(ray, 1, 0, memory);
    const glm::dvec3 b = rebuilt.light_along(ray, 1, 0, memory);
    EXPECT_LT(glm::distance(a, b), 1e-5);
  }
}

TEST_P(RaysThrough, HostileSplatsGiveFiniteColors) {
  Scene scene;
  scene.layers.push_back(layer_of(hostile_splats(GetParam())));
  const tracing::TracedScene traced(scene, background, in_order);
  Random random(17);
  tracing::RayMemory memory;
  for (int i = 0; i < 1000; ++i) {
    const tracing::Ray ray = random_ray(random, glm::dmat4(1.0));
    const tracing::BlendedSplats splats = traced.splats_on(ray, 1e30, memory);
    EXPECT_TRUE(std::isfinite(glm::dot(splats.color, splats.color)));
    EXPECT_TRUE(splats.transmittance >= 0 && splats.transmittance <= 1);
  }
}

INSTANTIATE_TEST_SUITE_P(EachKernel, RaysThrough, testing::ValuesIn(splat_kinds),
                         [](const auto& kind) { return std::string(kind.param.name); });

TEST(Rays, CopiesOfADiscMultiply) {
  for (const int copies : {1, 2, 3, 17}) {
    Gaussians discs{.flat = true};
    for (int i = 0; i < copies; ++i) {
      discs.centers.emplace_back(0.25f, -0.5f, 1.0f);
      discs.scales.emplace_back(0.5f);
      discs.rotations.push_back(glm::angleAxis(0.3f, glm::vec3(1, 0, 0)));
      discs.opacity.push_back(0.25f);
    }
    Scene scene;
    scene.layers.push_back(
        layer_of(Splats{.kernel = discs,
                        .color = {.coefficients = std::vector<glm::vec3>(std::size_t(copies))},
                        .profile = *profile_named("redisplats")}));
    const tracing::TracedScene traced(scene, glm::vec3(0.0f), in_order);
    tracing::RayMemory memory;
    // Through the centre, from both sides.
    for (const double side : {-1.0, 1.0}) {
      const tracing::Ray ray{{0.25, -0.5, 1 - 2 * side}, {0, 0, side}};
      const tracing::BlendedSplats result = traced.splats_on(ray, INFINITY, memory);
      EXPECT_NEAR(result.transmittance, std::pow(0.75, copies), 2e-6);
      EXPECT_NEAR(result.color.x, 0.5 * (1 - std::pow(0.75, copies)), 2e-6);
    }
  }
}

TEST(Rays, SoupsOfEachAppearanceAgreeWithTheOracle) {
  for (const Kind kind : all_kinds)
    for (const Place& place : places()) {
      Scene scene;
      scene.layers.push_back(
          layer_of(random_soup(21, {.kind = kind, .faces = 300, .size = 0.3, .degenerate = true}),
                   place.world_from_layer));
      scene.layers.push_back(
          layer_of(random_splats(splat_kinds[1], 100, 0.2, 22), place.world_from_layer));
      compare(scene, to_string(kind) + ", " + place.name, 500);
    }
}

/// Rays along the edges and through the corners of a closed mesh.
TEST(Rays, NoRaySlipsThroughAMesh) {
  Scene scene;
  for (const double offset : {0.0, 1e6})
    for (const double scale : {1e-4, 1.0, 1e4}) {
      scene.layers = {layer_of(unit_ball(4), ball_at(glm::dvec3(offset), scale))};
      const tracing::TracedScene traced(scene, background, in_order);
      const auto& soup = std::get<TriangleSoup>(scene.layers[0].primitives);
      Random random(23);
      for (int i = 0; i < 3000; ++i) {
        const glm::uvec3& t = soup.triangles[random.below(unsigned(soup.triangles.size()))];
        const double along = random.below(4) ? random.uniform() : 0.0;
        const glm::dvec3 target = (1 - along) * glm::dvec3(soup.positions[t[0]]) +
                                  along * glm::dvec3(soup.positions[t[1]]);
        const glm::dvec3 inside = 0.5 * random.uniform() * random.direction();
        const tracing::SurfaceOnRay hit = traced.surface_on(
            {glm::dvec3(offset) + scale * inside, glm::normalize(target - inside)});
        EXPECT_TRUE(hit.exists()) << "offset " << offset << ", scale " << scale;
      }
    }
}

}  // namespace rays_test
}  // namespace tureen::test
