// The oracle's Gaussians by EWA, against closed forms and projected points.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/matrix.hpp>

#include "oracle/ewa.hpp"
#include "tests/oracle/splats_in_view.hpp"

namespace tureen {
namespace oracle_gaussians_test {

using oracle::EwaInView;
using oracle::SplatView;
using LowPass = SplatProfile::LowPass;

constexpr double near = 1e-3;
constexpr SplatProfile unfiltered{};
constexpr SplatProfile dilated{.low_pass = LowPass::dilation};
constexpr SplatProfile mip{.low_pass = LowPass::mip};

Gaussians one_gaussian(const glm::dvec3& center, const glm::dvec3& scales,
                       const glm::quat& rotation = {1, 0, 0, 0}, float opacity = 0.8f) {
  return {{center}, {scales}, {rotation}, {opacity}};
}

class OracleGaussians : public testing::Test {
 protected:
  Camera camera_ = test::straight_camera(200, 150, 150);
  SplatView view_{glm::dmat4(1.0), camera_, near};
  test::Random random_{2};

  glm::dvec3 image_of(const glm::dvec3& p) const {
    return {camera_.cx - camera_.fx * p.x / p.z, camera_.cy + camera_.fy * p.y / p.z, 0};
  }
};

TEST_F(OracleGaussians, OfOneScaleHasAClosedForm) {
  const Gaussians gaussians = one_gaussian({0, 0, -4}, glm::dvec3(0.125));
  const double variance = std::pow(150 * 0.125 / 4, 2);
  const auto plain = EwaInView::project(gaussians, 0, unfiltered, view_);
  const auto wide = EwaInView::project(gaussians, 0, dilated, view_);
  const auto compensated = EwaInView::project(gaussians, 0, mip, view_);
  ASSERT_TRUE(plain && wide && compensated);
  const double opacity = 0.8f;
  EXPECT_NEAR(compensated->opacity(), opacity * variance / (variance + 0.3), 1e-14);
  for (const glm::dvec2& offset : {glm::dvec2(0, 0), glm::dvec2(3, 1), glm::dvec2(-2, 5)}) {
    const glm::dvec2 pixel = glm::dvec2(100, 75) + offset;
    const double d2 = glm::dot(offset, offset);
    EXPECT_NEAR(plain->at(pixel).alpha, opacity * std::exp(-d2 / (2 * variance)), 1e-14);
    EXPECT_NEAR(wide->at(pixel).alpha, opacity * std::exp(-d2 / (2 * (variance + 0.3))), 1e-14);
    EXPECT_NEAR(compensated->at(pixel).alpha,
                compensated->opacity() * std::exp(-d2 / (2 * (variance + 0.3))), 1e-14);
    EXPECT_EQ(plain->at(pixel).depth, 4);
  }
}

// A Gaussian that is small against its distance: the projection is affine over its extent.
TEST_F(OracleGaussians, EqualsProjectedPointsInTheAffineLimit) {
  for (int i = 0; i < 200; ++i) {
    const double depth = random_.uniform(500, 1000);
    const glm::dvec2 pixel(random_.uniform(0, 200), random_.uniform(0, 150));
    const Gaussians gaussians = one_gaussian(
        test::point_at(camera_, pixel, depth),
        {random_.uniform(0.01, 0.1), random_.uniform(0.01, 0.1), random_.uniform(0.01, 0.1)},
        test::random_rotation(random_));
    const glm::dvec3 center(gaussians.centers[0]), scales(gaussians.scales[0]);
    const glm::dmat3 axes = glm::mat3_cast(glm::normalize(glm::dquat(gaussians.rotations[0])));
    glm::dmat2 covariance(0.0);
    for (int k = 0; k < 3; ++k) {
      const glm::dvec2 d = 0.5 * glm::dvec2(image_of(center + scales[k] * axes[k]) -
                                            image_of(center - scales[k] * axes[k]));
      covariance += glm::outerProduct(d, d);
    }
    const auto splat = EwaInView::project(gaussians, 0, unfiltered, view_);
    ASSERT_TRUE(splat);
    const glm::dvec2 from_center(random_.uniform(-0.02, 0.02), random_.uniform(-0.02, 0.02));
    const double q = glm::dot(from_center, glm::inverse(covariance) * from_center);
    // The differences to second order cancel; the third order is (scale / depth)^2 < 1e-7.
    EXPECT_NEAR(splat->squared_distance(splat->center() + from_center), q, 1e-6 * q);
  }
}

// 3DGS's own formula (arXiv 2308.04079, and its code for the limit of J).
TEST_F(OracleGaussians, LimitsTheJacobianAs3dgs) {
  for (const double x : {-9.0, -0.5, 0.4, 2.0, 30.0}) {
    const glm::dvec3 scales(1.5, 0.25, 0.5);
    const Gaussians gaussians =
        one_gaussian({x, 1.25, -2}, scales, test::random_rotation(random_), 1);
    const glm::dmat3 axes = glm::mat3_cast(glm::normalize(glm::dquat(gaussians.rotations[0])));
    // View coordinates of 3DGS: y down, z forward.
    const glm::dmat3 flip(1, 0, 0, 0, -1, 0, 0, 0, -1);
    const glm::dvec3 t = flip * glm::dvec3(gaussians.centers[0]);
    const double limit_x = 1.3 * 100 / 150, limit_y = 1.3 * 75 / 150;
    const double tx = std::min(limit_x, std::max(-limit_x, t.x / t.z)) * t.z;
    const double ty = std::min(limit_y, std::max(-limit_y, t.y / t.z)) * t.z;
    const glm::dmat3 jacobian(150 / t.z, 0, 0, 0, 150 / t.z, 0, -150 * tx / (t.z * t.z),
                              -150 * ty / (t.z * t.z), 0);
    const glm::dmat3 scaled(axes[0] * scales.x, axes[1] * scales.y, axes[2] * scales.z);
    const glm::dmat3 m = jacobian * flip * scaled;
    glm::dmat2 covariance(m * glm::transpose(m));
    covariance[0][0] += 0.3;
    covariance[1][1] += 0.3;
    const auto splat = EwaInView::project(gaussians, 0, dilated, view_);
    ASSERT_TRUE(splat);
    for (int i = 0; i < 20; ++i) {
      const glm::dvec2 d(random_.uniform(-50, 50), random_.uniform(-50, 50));
      const double q = glm::dot(d, glm::inverse(covariance) * d);
      EXPECT_NEAR(splat->squared_distance(splat->center() + d), q, 1e-9 * q);
    }
  }
}

TEST_F(OracleGaussians, NeedlesKeepTheirDigits) {
  const double depth = 4, large = 1, small = 1e-4, angle = 0.3;
  const glm::quat rotation(float(std::cos(angle / 2)), 0, 0, float(std::sin(angle / 2)));
  const Gaussians gaussians = one_gaussian({0, 0, -depth}, {large, small, small}, rotation, 1);
  const double small_px = 150 * double(gaussians.scales[0].y) / depth, large_px = 150 / depth;
  const double turned = 2 * std::atan2(double(rotation.z), double(rotation.w));
  const auto splat = EwaInView::project(gaussians, 0, unfiltered, view_);
  ASSERT_TRUE(splat);
  for (int i = 0; i < 100; ++i) {
    const double u = random_.uniform(-3, 3), v = random_.uniform(-3, 3);
    const double x = u * large_px, y = v * small_px;
    const glm::dvec2 d(x * std::cos(turned) - y * std::sin(turned),
                       -x * std::sin(turned) - y * std::cos(turned));
    // Offsets of 100 px have a rounding of 1e-14, which is 4e-12 of the small axis; the
    // decomposition adds aspect times epsilon, 2e-12.
    EXPECT_NEAR(splat->squared_distance(splat->center() + d), u * u + v * v, 1e-9);
  }
}

// Mip-Splatting keeps opacity times area when a Gaussian becomes smaller than a pixel.
TEST_F(OracleGaussians, MipKeepsTheIntegral) {
  for (const double scale : {1.0, 1e-2, 1e-4}) {
    const Gaussians gaussians = one_gaussian({0.5, 0.25, -6}, glm::dvec3(1.0, 0.5, 0.25) * scale,
                                             test::random_rotation(random_), 1);
    const SplatProfile low{.low_pass = LowPass::mip, .min_alpha = 1e-6f};
    const SplatProfile plain{.min_alpha = 1e-6f};
    const auto filtered = EwaInView::project(gaussians, 0, low, view_);
    if (scale < 1e-3) {
      // An opacity of less than min_alpha.
      EXPECT_TRUE(!filtered || filtered->opacity() < 1e-4);
      continue;
    }
    const auto sharp = EwaInView::project(gaussians, 0, plain, view_);
    ASSERT_TRUE(filtered && sharp);
    // The integral is opacity / sqrt(det of the inverse covariance), from three values of q.
    const auto area = [](const EwaInView& splat) {
      const auto q = [&](double x, double y) {
        return splat.squared_distance(splat.center() + glm::dvec2(x, y));
      };
      const double xx = q(1, 0), yy = q(0, 1), xy = (q(1, 1) - xx - yy) / 2;
      return splat.opacity() / std::sqrt(xx * yy - xy * xy);
    };
    EXPECT_NEAR(area(*filtered) / area(*sharp), 1, 1e-9);
  }
  EXPECT_FALSE(EwaInView::project(one_gaussian({0, 0, -4}, glm::dvec3(1e-20)), 0, mip, view_));
}

TEST_F(OracleGaussians, AtOrBehindTheNearPlaneAreNotDrawn) {
  const SplatView view(glm::dmat4(1.0), camera_, 2.0);
  EXPECT_TRUE(EwaInView::project(one_gaussian({0, 0, -2.5}, glm::dvec3(1)), 0, dilated, view));
  EXPECT_FALSE(EwaInView::project(one_gaussian({0, 0, -2}, glm::dvec3(1)), 0, dilated, view));
  EXPECT_FALSE(EwaInView::project(one_gaussian({0, 0, 3}, glm::dvec3(1)), 0, dilated, view));
}

TEST_F(OracleGaussians, FlatOnesIgnoreTheirScaleAlongZ) {
  Gaussians thick = one_gaussian({0.25, 0, -3}, {0.5, 0.25, 0}, test::random_rotation(random_));
  Gaussians flat = thick;
  flat.flat = true;
  flat.scales[0].z = 5;
  const auto a = EwaInView::project(thick, 0, dilated, view_);
  const auto b = EwaInView::project(flat, 0, dilated, view_);
  ASSERT_TRUE(a && b);
  for (int i = 0; i < 20; ++i) {
    const glm::dvec2 pixel(random_.uniform(80, 140), random_.uniform(50, 100));
    EXPECT_EQ(a->at(pixel).alpha, b->at(pixel).alpha);
    EXPECT_EQ(a->at(pixel).order, b->at(pixel).order);
  }
}

TEST_F(OracleGaussians, AreOrderedByTheLargestDensityAlongTheRay) {
  for (int i = 0; i < 50; ++i) {
    const Gaussians gaussians = one_gaussian(
        {random_.uniform(-0.2, 0.2), random_.uniform(-0.2, 0.2), -4},
        {random_.uniform(0.1, 0.5), random_.uniform(0.1, 0.5), random_.uniform(0.1, 0.5)},
        test::random_rotation(random_));
    const auto splat = EwaInView::project(gaussians, 0, dilated, view_);
    ASSERT_TRUE(splat);
    const glm::dvec2 pixel = splat->center() + glm::dvec2(random_.uniform(-5, 5), 3);
    const glm::dmat3 axes = glm::mat3_cast(glm::normalize(glm::dquat(gaussians.rotations[0])));
    const auto squared = [&](double depth) {
      const glm::dvec3 d = test::point_at(camera_, pixel, depth) - glm::dvec3(gaussians.centers[0]);
      const glm::dvec3 local = d * axes / glm::dvec3(gaussians.scales[0]);
      return glm::dot(local, local);
    };
    const oracle::SplatSample sample = splat->at(pixel);
    ASSERT_GT(sample.alpha, 0);
    EXPECT_LT(squared(sample.order), squared(sample.order + 1e-4));
    EXPECT_LT(squared(sample.order), squared(sample.order - 1e-4));
  }
}

}  // namespace oracle_gaussians_test
}  // namespace tureen
