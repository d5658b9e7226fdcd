// The plan of splats: what is skipped, the largest colour, and the formats in which they are
// blended.
#include "runtime/plan/splat_plan.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <random>

#include "runtime/prepared_scene.hpp"
#include "runtime/splats/splat_target.hpp"
#include "scene/spherical_harmonics.hpp"
#include "tests/support/random_splats.hpp"

namespace tureen::test {
namespace splat_plan_test {

TEST(SplatPlan, NamesWhatIsLeftOut) {
  Splats splats = random_splats(splat_kinds[1], 10, 0.1, 1);
  std::get<Gaussians>(splats.kernel).opacity[3] = 0.5f * splats.profile.min_alpha;
  for (std::size_t i = 0; i < splats.color.coefficients.size(); ++i)
    if (i % 9 >= 4) splats.color.coefficients[i] = glm::vec3(0);  // of degree 2
  Scene scene;
  scene.layers.push_back({.primitives = splats});
  const auto applied = [&](const PlanPreferences& preferences, bool software = true) {
    const DeviceLimits limits{
        .max_texture_size = 2048, .max_array_layers = 256, .software = software};
    return prepare_scene(scene, limits, {.plan = preferences}).plan.applied();
  };
  const AppliedSpecialisation bands{Specialisation::harmonics_bands, 1, 2};
  const AppliedSpecialisation transparent{Specialisation::transparent_splats, 1, 10};
  const AppliedSpecialisation hidden{Specialisation::hidden_splats, 0, 0, 0.5};
  using List = std::vector<AppliedSpecialisation>;
  EXPECT_EQ(applied({.splat_blending = SplatBlending::raster}), (List{bands, transparent, hidden}));
  EXPECT_EQ(applied({.splat_blending = SplatBlending::raster}, false), (List{bands, transparent}));
  EXPECT_EQ(applied({.splat_blending = SplatBlending::tiles}), (List{bands, transparent}));
  EXPECT_EQ(applied({.specialise = false, .splat_blending = SplatBlending::raster}), List{});
  for (const AppliedSpecialisation& each : List{bands, transparent, hidden}) {
    List others = {bands, transparent, hidden};
    std::erase(others, each);
    EXPECT_EQ(applied({.specialisations = SpecialisationSet::all().without(each.what),
                       .splat_blending = SplatBlending::raster}),
              others);
  }
}

TEST(SplatPlan, BoundsTheColoursOfEveryDirection) {
  std::mt19937 random(1);
  std::normal_distribution<float> normal;
  for (const int degree : {0, 1, 2, 3, 4}) {
    Splats splats = random_splats(splat_kinds[1], 50, 0.1, 1);
    const auto per_splat = std::size_t(harmonics::count(degree));
    splats.color = {.degree = degree};
    for (std::size_t i = 0; i < 50 * per_splat; ++i)
      splats.color.coefficients.emplace_back(normal(random), normal(random), normal(random));
    const float bound = make_splat_plan(splats).largest_color;
    float largest = 1;
    for (int direction = 0; direction < 2000; ++direction) {
      const auto basis = harmonics::basis(
          glm::normalize(glm::vec3(normal(random), normal(random), normal(random))));
      for (std::size_t i = 0; i < 50; ++i) {
        glm::vec3 color(0.5f);
        for (std::size_t k = 0; k < per_splat; ++k)
          color += basis[k] * splats.color.coefficients[per_splat * i + k];
        largest = std::max({largest, color.x, color.y, color.z});
      }
    }
    EXPECT_LE(largest, bound * 1.00001f) << degree;  // rounding of floats
    // Of 50 splats and 2000 directions, some are near the largest. Higher bands have sharper peaks.
    EXPECT_GT(largest, 0.5f * bound) << degree;
  }
}

TEST(SplatTarget, HasFractionsWhereTheyAreExactEnough) {
  gl::Capabilities device;
  device.float_blending = device.norm16_targets = true;
  const auto format = [&](SplatFormat requested, float min_alpha, float largest_color) {
    return blend_format(requested, device, min_alpha, largest_color).texture.internal_format;
  };
  constexpr float min_alpha = 1.0f / 255;
  const GLenum fractions = target_formats::rgba16.internal_format;
  EXPECT_EQ(format(SplatFormat::automatic, min_alpha, 2), fractions);
  EXPECT_EQ(blend_format(SplatFormat::automatic, device, min_alpha, 2).color_unit, 0.5f);
  EXPECT_EQ(format(SplatFormat::automatic, min_alpha, 9), GL_RGBA32F);
  EXPECT_EQ(format(SplatFormat::automatic, 1e-4f, 2), GL_RGBA32F);
  EXPECT_EQ(format(SplatFormat::rgba32f, min_alpha, 2), GL_RGBA32F);
  EXPECT_EQ(format(SplatFormat::rgba16f, min_alpha, 2), GL_RGBA16F);
  device.norm16_targets = false;
  EXPECT_EQ(format(SplatFormat::automatic, min_alpha, 2), GL_RGBA32F);
  device.float_blending = false;
  EXPECT_EQ(format(SplatFormat::automatic, min_alpha, 2), GL_RGBA16F);
}

}  // namespace splat_plan_test
}  // namespace tureen::test
