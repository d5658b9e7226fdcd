// Gradients of Gaussians and discs: derivatives in double precision against central differences
// and, as images, against the oracle; the vector kernels against these; the same bits with any
// number of threads.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include "oracle/oracle.hpp"
#include "tests/support/random.hpp"
#include "tests/trainer/gaussian_reference.hpp"
#include "tests/trainer/gradient_views.hpp"
#include "trainer/splats/gaussians/gaussian_training.hpp"

namespace tureen::trainer {
namespace splats_gradient_test {

namespace row = splatting::gaussian_row;
using test::background;
using test::camera;
using test::Dual;
using test::height;
using test::random_gradient;
using test::values_of;
using test::width;
using tureen::test::Random;

/// Splats in the ball of radius 1 about the origin.
GaussianParameters random_parameters(std::uint64_t seed, std::size_t count, int degree,
                                     double mean_logit = 0, double mean_log_scale = -1.8) {
  Random random(seed);
  GaussianParameters result(count, degree);
  for (std::size_t i = 0; i < count; ++i) {
    const auto set = [&](std::size_t r, double value) { result.trained(r)[i] = float(value); };
    const glm::dvec3 center = random.uniform(0, 1) * random.direction();
    for (int axis = 0; axis < 3; ++axis) {
      set(row::x + std::size_t(axis), center[axis]);
      set(row::scale_x + std::size_t(axis), mean_log_scale + 0.6 * random.normal());
    }
    for (std::size_t k = 0; k < 4; ++k) set(row::rotation_x + k, 1.7 * random.normal());
    set(row::opacity, mean_logit + random.normal());
    for (std::size_t r = row::harmonics; r < result.rows(); ++r) set(r, 0.25 * random.normal());
    result.activate(i);
  }
  return result;
}

struct GaussianKernel {
  template <class Real>
  using Reference = test::ReferenceGaussian<Real>;
  using Training = GaussianTraining;
  using Raster = TileRaster<Training>;
  using Moments = GaussianMoments;
  static float& red(Moments& moments) { return moments.red; }
  static constexpr bool flat = false;
  static constexpr std::string_view branches = "ncams";
};

struct DiscKernel {
  template <class Real>
  using Reference = test::ReferenceDisc<Real>;
  using Training = DiscTraining;
  using Raster = TileRaster<Training>;
  using Moments = DiscMoments;
  static float& red(Moments& moments) { return moments.one.color; }
  static constexpr bool flat = true;
  static constexpr std::string_view branches = "nfamsp";
};

template <class Kernel>
class SplatsGradient : public testing::Test {};
struct KernelNames {
  template <class Kernel>
  static std::string GetName(int) {
    return Kernel::flat ? "Discs" : "Gaussians";
  }
};
using Kernels = testing::Types<GaussianKernel, DiscKernel>;
TYPED_TEST_SUITE(SplatsGradient, Kernels, KernelNames);

template <class Kernel, class Real>
std::vector<Real> image_of(const std::vector<Real>& values, std::size_t rows, int degree,
                           test::Branches* branches = nullptr) {
  return test::reference_image<Kernel::template Reference>(values, rows, degree, camera(),
                                                           background, branches);
}

/// The derivative of sum(image . gradient) by each value.
template <class Kernel>
std::vector<double> reference_gradient(const GaussianParameters& parameters, int degree,
                                       const std::vector<float>& gradient) {
  return test::slopes_of(values_of<Dual>(parameters), [&](const std::vector<Dual>& values) {
    return test::sum_of(image_of<Kernel>(values, parameters.rows(), degree), gradient);
  });
}

/// Of the kernels, splat after splat.
template <class Kernel>
std::vector<float> kernel_gradient(const GaussianParameters& parameters, int degree,
                                   const std::vector<float>& gradient, int threads = 1) {
  ThreadPool pool(threads);
  typename Kernel::Raster raster(pool);
  std::vector<float> planes(gradient.size());
  raster.forward(parameters, camera(), degree, background, planes);
  const auto input = raster.backward(planes, gradient);
  splatting::ParameterRows rows(parameters.rows(), parameters.count());
  Kernel::Training::step_functions().gradients(input, {}, parameters, 0, parameters.count(), rows);
  std::vector<float> result;
  for (std::size_t i = 0; i < parameters.count(); ++i)
    for (std::size_t r = 0; r < parameters.rows(); ++r) result.push_back(rows.row(r)[i]);
  return result;
}

/// Each kind of parameter of each splat, relative to its length. Single precision gives about 1e-5
/// through the inverse covariance and the sums over pixels; thin splats lose a digit.
template <class Kernel>
void expect_agreement(const GaussianParameters& parameters, int degree, std::uint64_t seed) {
  const std::vector<float> by_image = random_gradient(seed);
  const std::vector<double> expected = reference_gradient<Kernel>(parameters, degree, by_image);
  const std::vector<float> actual = kernel_gradient<Kernel>(parameters, degree, by_image);
  test::expect_close(gaussian_parameter_kinds, parameters.rows(), actual, expected, 3e-4, 1e-5,
                     seed);
}

TYPED_TEST(SplatsGradient, OfTheReferenceIsThatOfDifferences) {
  for (const double mean_logit : {0.0, 4.0}) {  // with 4, many pixels reach the largest alpha
    const GaussianParameters parameters = random_parameters(1, 6, 3, mean_logit);
    const std::vector<float> by_image = random_gradient(2);
    const std::vector<double> gradient = reference_gradient<TypeParam>(parameters, 3, by_image);
    const auto loss = [&](const std::vector<double>& values) {
      return test::sum_of(image_of<TypeParam>(values, parameters.rows(), 3), by_image);
    };
    test::expect_differences(values_of<double>(parameters), gradient, parameters.rows(), loss);
  }
}

/// At both sides of each branch, the derivative is that of one-sided differences.
TYPED_TEST(SplatsGradient, OfTheReferenceHoldsAtBranches) {
  GaussianParameters parameters = random_parameters(7, 14, 1, 3.5, -1.4);
  // A large disc before the eye, which turns through it: some rays meet its plane behind the eye.
  constexpr std::size_t turning = 6;
  const float large[] = {0.3f, -0.4f, 3.6f, 0.5f, 0.5f, 0.5f, 0.1f, 0, 0, 1};
  for (std::size_t r = 0; r < std::size(large); ++r) parameters.trained(r)[turning] = large[r];
  parameters.activate(turning);
  const std::vector<float> by_image = random_gradient(8);
  // The third derivative reaches 2e7 where the disc is seen from its edge.
  auto scan = test::branch_scan<double>(
      values_of<double>(parameters), 3e-7, [&](const auto& values, test::Branches& branches) {
        return test::sum_of(image_of<TypeParam>(values, parameters.rows(), 1, &branches), by_image);
      });
  const std::size_t rows = parameters.rows();
  for (std::size_t splat = 0; splat < 6; ++splat) {
    scan.scan(splat * rows + row::opacity, -7, 7, 40);
    scan.scan(splat * rows + row::z, 3, 4, 20);  // through the smallest depth
    scan.scan(splat * rows + row::x, 0, 5, 20);  // out of the image
  }
  scan.scan(turning * rows + row::rotation_x, 0.1, 3, 40);
  for (const char branch : TypeParam::branches)
    EXPECT_NE(scan.met().find(branch), std::string::npos) << branch;
}

TYPED_TEST(SplatsGradient, OfTheReferenceBelongsToTheImageOfTheOracle) {
  const GaussianParameters parameters = random_parameters(3, 40, 3, 1);
  Scene scene;
  scene.layers.push_back({.primitives = parameters.splats(TypeParam::flat)});
  const OracleImage expected = render_oracle(
      scene, {camera()}, {.background = glm::vec3(background[0], background[1], background[2])});
  const std::vector<double> image =
      image_of<TypeParam>(values_of<double>(parameters), parameters.rows(), 3);
  for (std::size_t pixel = 0; pixel < expected.color.pixels.size(); ++pixel)
    for (std::size_t c = 0; c < 3; ++c)
      // Scales, rotations and opacities are rounded to floats before the oracle draws.
      EXPECT_NEAR(std::clamp(image[c * width * height + pixel], 0.0, 1.0),
                  expected.color.pixels[pixel][int(c)], 1e-5);
}

TYPED_TEST(SplatsGradient, ImagesOfTheKernelsAreThoseOfTheReference) {
  const GaussianParameters parameters = random_parameters(4, 40, 3, 1);
  ThreadPool pool(1);
  typename TypeParam::Raster raster(pool);
  std::vector<float> planes(3 * width * height);
  raster.forward(parameters, camera(), 3, background, planes);
  const std::vector<double> image =
      image_of<TypeParam>(values_of<double>(parameters), parameters.rows(), 3);
  for (std::size_t k = 0; k < image.size(); ++k)
    EXPECT_NEAR(double(planes[k]), image[k], 2e-5);  // rounding; no splat is near a limit here
}

TYPED_TEST(SplatsGradient, OfTheKernelsIsThatOfTheReference) {
  for (std::uint64_t seed = 10; seed < 14; ++seed)
    expect_agreement<TypeParam>(random_parameters(seed, 9, 3), 3, seed);
}

/// More splats than a batch in each block, which reach the stop.
TYPED_TEST(SplatsGradient, HoldsBehindManySplats) {
  expect_agreement<TypeParam>(random_parameters(20, 40, 1, 1.5), 1, 20);
}

TYPED_TEST(SplatsGradient, HoldsWhereAlphaIsLimited) {
  expect_agreement<TypeParam>(random_parameters(21, 12, 0, 5), 0, 21);
}

/// Of the harmonics of lower degrees only, if only those are drawn.
TYPED_TEST(SplatsGradient, HoldsForFewerDegrees) {
  for (int degree = 0; degree < 3; ++degree)
    expect_agreement<TypeParam>(random_parameters(22, 6, 3), degree, 22);
}

TYPED_TEST(SplatsGradient, OfLimitedColorsAndHiddenSplatsIsZero) {
  GaussianParameters parameters = random_parameters(23, 3, 0);
  parameters.trained(row::harmonics)[0] = -5;  // no red
  parameters.trained(row::z)[1] = 3.9f;        // before the least depth
  parameters.trained(row::opacity)[2] = -9;    // below the smallest alpha
  for (std::size_t i = 0; i < 3; ++i) parameters.activate(i);
  const std::vector<float> gradient = kernel_gradient<TypeParam>(parameters, 0, random_gradient(1));
  const std::size_t rows = parameters.rows();
  EXPECT_EQ(gradient[row::harmonics], 0);
  EXPECT_NE(gradient[row::harmonics + 1], 0);
  for (std::size_t k = rows; k < gradient.size(); ++k) EXPECT_EQ(gradient[k], 0) << k;
  expect_agreement<TypeParam>(parameters, 0, 23);
}

/// A centre outside of the image; of Gaussians, beyond the margin of the Jacobian.
TYPED_TEST(SplatsGradient, HoldsBesideTheImage) {
  GaussianParameters parameters = random_parameters(24, 2, 1, 2);
  for (std::size_t axis = 0; axis < 3; ++axis) parameters.trained(row::scale_x + axis)[0] = 0.5f;
  parameters.trained(row::x)[0] = 3.5f;
  for (std::size_t i = 0; i < 2; ++i) parameters.activate(i);
  expect_agreement<TypeParam>(parameters, 1, 24);
}

TYPED_TEST(SplatsGradient, HasTheSameBitsWithMoreThreads) {
  const GaussianParameters parameters = random_parameters(30, 500, 2);
  const std::vector<float> by_image = random_gradient(30);
  const std::vector<float> one = kernel_gradient<TypeParam>(parameters, 2, by_image, 1);
  for (const int threads : {2, 5}) {
    const std::vector<float> more = kernel_gradient<TypeParam>(parameters, 2, by_image, threads);
    EXPECT_EQ(std::memcmp(one.data(), more.data(), one.size() * sizeof(float)), 0) << threads;
  }
}

/// One splat that is not finite neither moves nor stops the others.
TYPED_TEST(SplatsGradient, ThatIsNotFiniteIsQuarantined) {
  GaussianParameters parameters = random_parameters(31, 20, 1);
  ThreadPool pool(1);
  typename TypeParam::Raster raster(pool);
  std::vector<float> planes(3 * width * height);
  raster.forward(parameters, camera(), 1, background, planes);
  const auto input = raster.backward(planes, random_gradient(31));
  std::vector<typename TypeParam::Moments> moments(input.moments.begin(), input.moments.end());
  ASSERT_LT(input.pairs[7].begin, input.pairs[7].end);
  TypeParam::red(moments[input.pairs[7].begin]) = std::numeric_limits<float>::quiet_NaN();
  const GaussianParameters before = parameters;
  SplatMemory memory(parameters.rows(), parameters.count());
  const GaussianStep step{.rates = {1e-3f, 1e-3f, 1e-3f, 1e-3f, 1e-3f, 1e-3f},
                          .min_log_scale = -20,
                          .max_log_scale = 20};
  const decltype(raster.backward({}, {})) damaged{input.view, input.degree, input.pairs, moments};
  EXPECT_EQ(TypeParam::Training::step_functions().step(damaged, step, 0, 20, parameters, memory),
            1u);
  for (std::size_t i = 0; i < 20; ++i) {
    if (input.pairs[i].begin == input.pairs[i].end) continue;
    EXPECT_EQ(parameters.trained(row::opacity)[i] == before.trained(row::opacity)[i], i == 7) << i;
    // The first step of Adam is the rate.
    if (i != 7) {
      EXPECT_NEAR(std::abs(parameters.trained(row::x)[i] - before.trained(row::x)[i]), 1e-3, 1e-6);
    }
  }
}

/// An infinite colour is drawn as a finite one: the pixels, and the other splats in them, stay
/// finite.
TYPED_TEST(SplatsGradient, HoldsBesideAnInfiniteColor) {
  GaussianParameters parameters = random_parameters(31, 20, 1);
  parameters.trained(row::harmonics)[7] = std::numeric_limits<float>::infinity();
  parameters.activate(7);
  ThreadPool pool(1);
  typename TypeParam::Raster raster(pool);
  std::vector<float> planes(3 * width * height);
  raster.forward(parameters, camera(), 1, background, planes);
  EXPECT_GT(*std::max_element(planes.begin(), planes.end()), 1000);
  for (const float value : planes) ASSERT_TRUE(std::isfinite(value));
  SplatMemory memory(parameters.rows(), parameters.count());
  const GaussianStep step{.rates = {1e-3f, 1e-3f, 1e-3f, 1e-3f, 1e-3f, 1e-3f},
                          .min_log_scale = -20,
                          .max_log_scale = 20};
  const GaussianParameters before = parameters;
  EXPECT_EQ(TypeParam::Training::step_functions().step(raster.backward(planes, random_gradient(31)),
                                                       step, 0, 20, parameters, memory),
            0u);
  std::size_t moved = 0;
  for (std::size_t i = 0; i < 20; ++i) {
    EXPECT_TRUE(i == 7 || parameters.is_finite(i)) << i;
    moved += parameters.trained(row::x)[i] != before.trained(row::x)[i];
  }
  EXPECT_GT(moved, 10u);
}

}  // namespace splats_gradient_test
}  // namespace tureen::trainer
