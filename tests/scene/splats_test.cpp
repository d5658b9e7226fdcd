#include "scene/splats.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <glm/gtc/quaternion.hpp>
#include <limits>

#include "scene/edit/morton_order.hpp"
#include "scene/edit/opaque_windows.hpp"
#include "scene/edit/splat_edits.hpp"
#include "scene/scene_remarks.hpp"
#include "scene/spherical_harmonics.hpp"

namespace tureen {
namespace splats_test {

using testing::HasSubstr;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

TriangleWindows windows() {
  return {.corners = {{0, 0, 0}, {1, 0, 0}, {0, 2, 3}, {5, 5, 5}, {6, 5, 5}, {5, 6, 5}},
          .sigma = {0.01f, 3},
          .opacity = {0, 1}};
}

Gaussians gaussians() {
  const glm::quat turned = glm::angleAxis(0.7f, glm::normalize(glm::vec3(1, 2, 3)));
  return {.centers = {{0, 0, 0}, {1, 2, 3}},
          .scales = {{0.1f, 0.2f, 0.3f}, {1, 0, 1}},
          .rotations = {glm::quat(1, 0, 0, 0), turned},
          .opacity = {0.5f, 1}};
}

NeuralDensities densities() {
  return {.centers = {{0, 0, 0}},
          .semi_axes = {{1, 2, 3}},
          .rotations = {glm::quat(1, 0, 0, 0)},
          .networks = std::vector<float>(NeuralDensities::parameters, 0.1f)};
}

Splats splats_of(SplatKernel kernel, const char* profile, int degree = 0) {
  Splats splats{.kernel = std::move(kernel), .profile = *profile_named(profile)};
  splats.color.degree = degree;
  splats.color.coefficients.resize(count(splats) * harmonics::count(degree));
  return splats;
}

std::vector<Splats> one_of_each() {
  Gaussians flat = gaussians();
  flat.flat = true;
  return {splats_of(windows(), "triangle-splatting"),
          splats_of(gaussians(), "3dgs", 4),
          splats_of(gaussians(), "mip"),
          splats_of(flat, "2dgs"),
          splats_of(flat, "redisplats"),
          splats_of(flat, "games"),
          splats_of(densities(), "splatnet")};
}

/// windows() with a colour at each corner: coefficient j of corner i is (i, j, 0).
Splats windows_per_corner() {
  Splats splats = splats_of(windows(), "mesh-splatting");
  splats.color = {.degree = 1, .coefficients = {}, .per_corner = true};
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 4; ++j) splats.color.coefficients.emplace_back(i, j, 0);
  return splats;
}

TEST(Splats, CornersHaveColours) {
  Splats splats = windows_per_corner();
  EXPECT_EQ(coefficients_per_splat(splats.color), 12u);
  EXPECT_EQ(defect(splats), std::nullopt);
  EXPECT_THAT(describe(splats), HasSubstr("mesh-splatting, harmonics of degree 1 per corner"));
  splats.color.coefficients.pop_back();
  EXPECT_THAT(defect(splats).value_or(""), HasSubstr("23 harmonics coefficients, expected 24"));
  Splats others = splats_of(gaussians(), "3dgs");
  others.color.per_corner = true;
  EXPECT_THAT(defect(others).value_or(""), HasSubstr("corners"));
}

TEST(Splats, WindowsKeepTheirOwnColours) {
  Splats splats = windows_per_corner();
  splats = keep_splats(std::move(splats), std::vector<std::uint8_t>{0, 1});
  EXPECT_EQ(count(splats), 1u);
  EXPECT_EQ(defect(splats), std::nullopt);
  EXPECT_EQ(std::get<TriangleWindows>(splats.kernel).corners[2], glm::vec3(5, 6, 5));
  EXPECT_EQ(std::get<TriangleWindows>(splats.kernel).sigma[0], 3);
  EXPECT_EQ(splats.color.coefficients[0], glm::vec3(3, 0, 0));
  EXPECT_EQ(splats.color.coefficients[11], glm::vec3(5, 3, 0));

  // The second window has the lower place in Morton order.
  splats = windows_per_corner();
  for (glm::vec3& corner : std::get<TriangleWindows>(splats.kernel).corners) corner = -corner;
  sort_in_morton_order(splats);
  EXPECT_EQ(std::get<TriangleWindows>(splats.kernel).corners[2], -glm::vec3(5, 6, 5));
  EXPECT_EQ(splats.color.coefficients[0], glm::vec3(3, 0, 0));
  EXPECT_EQ(splats.color.coefficients[23], glm::vec3(2, 3, 0));
}

TEST(Splats, OpaqueWindowsKeepTheColoursOfTheirCorners) {
  const OpaqueResult result = to_opaque(windows_per_corner());
  EXPECT_EQ(defect(result.soup), std::nullopt);
  const auto& harmonics = std::get<Harmonics>(result.soup.appearance);
  EXPECT_EQ(harmonics.domain, Harmonics::Domain::vertex);
  EXPECT_EQ(harmonics.coefficients[0], glm::vec3(3, 0, 0));  // the first window has opacity 0
  EXPECT_THAT(result.remarks, testing::Contains(Remark{&remarks::screen_interpolation_dropped}));
}

TEST(Splats, OfEveryKernelHaveNoDefect) {
  for (const Splats& splats : one_of_each()) EXPECT_EQ(defect(splats), std::nullopt);
  EXPECT_EQ(defect(Splats{}), std::nullopt);
}

TEST(Splats, AWrongSizeIsADefect) {
  for (const Splats& good : one_of_each()) {
    Splats bad = good;
    bad.color.coefficients.pop_back();
    EXPECT_THAT(defect(bad).value_or(""), HasSubstr("coefficients"));
  }
  Splats bad = splats_of(windows(), "triangle-splatting");
  std::get<TriangleWindows>(bad.kernel).sigma.pop_back();
  EXPECT_THAT(defect(bad).value_or(""), HasSubstr("sigmas"));
  bad = splats_of(gaussians(), "3dgs");
  std::get<Gaussians>(bad.kernel).rotations.pop_back();
  EXPECT_THAT(defect(bad).value_or(""), HasSubstr("rotations"));
  bad = splats_of(densities(), "splatnet");
  std::get<NeuralDensities>(bad.kernel).networks.pop_back();
  EXPECT_THAT(defect(bad).value_or(""), HasSubstr("network parameters"));
}

/// The defect after a change of the kernel `K`.
template <class K>
std::string defect_after(Splats splats, const std::function<void(K&)>& change) {
  change(std::get<K>(splats.kernel));
  return defect(splats).value_or("");
}

TEST(Splats, AValueOutsideItsRangeIsADefect) {
  for (const float bad : {nan, infinity, -1.0f}) {
    EXPECT_THAT(defect_after<TriangleWindows>(splats_of(windows(), "triangle-splatting"),
                                              [&](TriangleWindows& k) { k.sigma[1] = bad; }),
                HasSubstr("splat 1 has a sigma"));
    EXPECT_THAT(defect_after<TriangleWindows>(splats_of(windows(), "triangle-splatting"),
                                              [&](TriangleWindows& k) { k.opacity[0] = bad; }),
                HasSubstr("splat 0 has an opacity"));
    EXPECT_THAT(defect_after<Gaussians>(splats_of(gaussians(), "3dgs"),
                                        [&](Gaussians& k) { k.scales[1].y = bad; }),
                HasSubstr("splat 1 has a scale"));
    EXPECT_THAT(defect_after<NeuralDensities>(splats_of(densities(), "splatnet"),
                                              [&](NeuralDensities& k) { k.semi_axes[0].z = bad; }),
                HasSubstr("semi-axis"));
  }
  EXPECT_THAT(defect_after<TriangleWindows>(splats_of(windows(), "triangle-splatting"),
                                            [](TriangleWindows& k) { k.sigma[0] = 0; }),
              HasSubstr("splat 0 has a sigma"));
  EXPECT_THAT(defect_after<Gaussians>(splats_of(gaussians(), "3dgs"),
                                      [](Gaussians& k) { k.rotations[0] *= 1.1f; }),
              HasSubstr("unit length"));
  EXPECT_THAT(defect_after<Gaussians>(splats_of(gaussians(), "3dgs"),
                                      [](Gaussians& k) { k.centers[0].x = nan; }),
              HasSubstr("centre"));
}

TEST(Splats, AProfileOfAnotherKernelIsADefect) {
  EXPECT_NE(defect(splats_of(windows(), "3dgs")), std::nullopt);
  EXPECT_NE(defect(splats_of(gaussians(), "2dgs")), std::nullopt);  // not flat
  EXPECT_NE(defect(splats_of(densities(), "mip")), std::nullopt);
}

TEST(Splats, AProfileOutsideItsRangesIsADefect) {
  for (const float bad : {-0.1f, nan, INFINITY}) {
    Splats splats = splats_of(gaussians(), "3dgs");
    splats.profile.min_center_depth = bad;
    EXPECT_THAT(defect(splats).value_or(""), HasSubstr("depth")) << bad;
  }
}

TEST(Splats, NamedProfilesAreFoundByName) {
  for (const NamedProfile& each : named_profiles) {
    EXPECT_EQ(profile_named(each.name), each.profile);
    EXPECT_EQ(profile_named(name_of(each.profile)), each.profile);
  }
  EXPECT_EQ(profile_named("redisplats")->min_center_depth, 0);
  EXPECT_EQ(profile_named("mip")->min_center_depth, 0.2f);
  EXPECT_EQ(profile_named("nobody"), std::nullopt);
  EXPECT_EQ(name_of({.max_alpha = 0.5f}), "custom");
}

/// Gaussians are visible up to the distance at which their alpha is min_alpha.
TEST(Splats, TheBoundsOfGaussiansEndAtTheSmallestAlpha) {
  Splats splats = splats_of(gaussians(), "3dgs");
  auto& kernel = std::get<Gaussians>(splats.kernel);
  kernel.opacity[1] = 0.001f;  // never reaches 1/255
  const float reach = std::sqrt(2 * std::log(0.5f * 255));
  const Bounds box = bounds(splats);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(box.high[axis], reach * kernel.scales[0][axis], 1e-5);
    EXPECT_NEAR(box.low[axis], -reach * kernel.scales[0][axis], 1e-5);
  }
  kernel.flat = true;
  EXPECT_EQ(bounds(splats).high.z, 0);
  kernel.opacity = {0, 0};
  EXPECT_EQ(bounds(splats).high, glm::vec3(0));
}

TEST(Splats, TheBoundsOfARotatedSplatContainItsSurface) {
  Splats splats = splats_of(densities(), "splatnet");
  auto& kernel = std::get<NeuralDensities>(splats.kernel);
  kernel.rotations[0] = glm::angleAxis(1.0f, glm::normalize(glm::vec3(1, -2, 0.5f)));
  const Bounds box = bounds(splats);
  glm::vec3 high(-1e9f);
  for (int i = 0; i < 200; ++i)
    for (int j = 0; j <= 100; ++j) {
      const double azimuth = i * 0.01 * 3.14159265, polar = j * 0.01 * 3.14159265;
      const glm::vec3 unit(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
                           std::cos(polar));
      high = glm::max(high, kernel.rotations[0] * (kernel.semi_axes[0] * unit));
    }
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_GE(box.high[axis], high[axis] - 1e-6f);
    EXPECT_LE(box.high[axis], high[axis] + 1e-2f);  // the sampling's distance
  }
}

}  // namespace splats_test
}  // namespace tureen
