// Gradients of triangle windows: derivatives in double precision against central differences and,
// as images, against the oracle; the vector kernels against these; the same bits with any number of
// threads.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>

#include "oracle/oracle.hpp"
#include "tests/support/random.hpp"
#include "tests/trainer/gradient_views.hpp"
#include "tests/trainer/window_reference.hpp"
#include "trainer/splats/windows/window_training.hpp"

namespace tureen::trainer {
namespace window_gradient_test {

namespace row = splatting::window_row;
using test::background;
using test::camera;
using test::Dual;
using test::height;
using test::random_gradient;
using test::values_of;
using test::width;
using tureen::test::Random;

/// Splats in the ball of radius 1 about the origin.
WindowParameters random_parameters(std::uint64_t seed, std::size_t count, int degree,
                                   double mean_logit = 0, double mean_log_sigma = -0.3) {
  Random random(seed);
  WindowParameters result(count, degree);
  for (std::size_t i = 0; i < count; ++i) {
    const auto set = [&](std::size_t r, double value) { result.trained(r)[i] = float(value); };
    const glm::dvec3 center = random.uniform(0, 1) * random.direction();
    for (int k = 0; k < 3; ++k) {
      const glm::dvec3 corner = center + random.uniform(0.2, 0.7) * random.direction();
      for (int axis = 0; axis < 3; ++axis)
        set(row::corners + std::size_t(3 * k + axis), corner[axis]);
    }
    set(row::sigma, mean_log_sigma + 0.5 * random.normal());
    set(row::opacity, mean_logit + random.normal());
    for (std::size_t r = row::harmonics; r < result.rows(); ++r) set(r, 0.25 * random.normal());
    result.activate(i);
  }
  return result;
}

template <class Real>
std::vector<Real> image_of(const std::vector<Real>& values, const WindowParameters& parameters,
                           int degree) {
  return test::reference_window_image(values, parameters.rows(), degree, camera(), background,
                                      double(parameters.solidity));
}

/// Each channel's variance in a pixel then has a derivative of 1.6; random_gradient() has a
/// deviation of 1.
constexpr float variance_like_noise = 2000;

/// The sum of image . by_image, and VarianceLoss.
template <class Real>
Real loss_of(const std::vector<Real>& values, const WindowParameters& parameters, int degree,
             const std::vector<float>& by_image, const VarianceLoss& variance) {
  const std::vector<Real> planes = image_of(values, parameters, degree);
  const double by_variance = double(variance.weight) / double(by_image.size());
  Real sum(0);
  for (std::size_t k = 0; k < by_image.size(); ++k)
    sum = sum + planes[k] * Real(double(by_image[k]));
  for (std::size_t pixel = 0; pixel < width * height; ++pixel)
    if (variance.ignored.empty() || !variance.ignored[pixel])
      sum = sum + planes[by_image.size() + pixel] * Real(by_variance);
  return sum;
}

/// The derivative of loss_of() by each value.
std::vector<double> reference_gradient(const WindowParameters& parameters, int degree,
                                       const std::vector<float>& by_image,
                                       const VarianceLoss& variance = {}) {
  std::vector<Dual> values = values_of<Dual>(parameters);
  std::vector<double> result;
  for (Dual& variable : values) {
    variable.slope = 1;
    result.push_back(loss_of(values, parameters, degree, by_image, variance).slope);
    variable.slope = 0;
  }
  return result;
}

/// Of the kernels, splat after splat.
std::vector<float> kernel_gradient(const WindowParameters& parameters, int degree,
                                   const std::vector<float>& gradient, int threads = 1,
                                   const WindowLoss& loss = {}, const VarianceLoss& variance = {}) {
  ThreadPool pool(threads);
  TileRaster<WindowTraining> raster(pool);
  std::vector<float> planes(gradient.size());
  raster.forward(parameters, camera(), degree, background, planes, variance.weight > 0);
  const BackwardInput<WindowMoments> input = raster.backward(planes, gradient, variance);
  splatting::ParameterRows rows(parameters.rows(), parameters.count());
  window_step_functions().gradients(input, {.rates = {}, .loss = loss}, parameters, 0,
                                    parameters.count(), rows);
  std::vector<float> result;
  for (std::size_t i = 0; i < parameters.count(); ++i)
    for (std::size_t r = 0; r < parameters.rows(); ++r) result.push_back(rows.row(r)[i]);
  return result;
}

/// Each kind of parameter of each splat, relative to its length. Single precision gives about 1e-5
/// through the lines of the edges and the sums over pixels; a pixel near an edge (rho 0.001) loses
/// three digits, and thin windows one.
void expect_agreement(const WindowParameters& parameters, int degree, std::uint64_t seed,
                      double tolerance = 3e-4, const VarianceLoss& variance = {}) {
  std::vector<float> by_image = random_gradient(seed);
  if (!variance.ignored.empty())  // as the image loss
    for (std::size_t k = 0; k < by_image.size(); ++k)
      if (variance.ignored[k % (width * height)]) by_image[k] = 0;
  const std::vector<double> expected = reference_gradient(parameters, degree, by_image, variance);
  const std::vector<float> actual = kernel_gradient(parameters, degree, by_image, 1, {}, variance);
  const std::size_t rows = parameters.rows();
  std::size_t moving = 0;
  for (std::size_t i = 0; i < parameters.count(); ++i)
    for (const ParameterKind& kind : window_parameter_kinds) {
      double difference = 0, length = 0;
      for (std::size_t r = kind.first; r < std::min(kind.first + kind.size, rows); ++r) {
        const double e = expected[i * rows + r];
        difference += std::pow(double(actual[i * rows + r]) - e, 2);
        length += e * e;
      }
      moving += length > 0;
      EXPECT_LE(std::sqrt(difference), tolerance * std::sqrt(length) + 1e-5)
          << kind.name << " of splat " << i << ", seed " << seed << ", length "
          << std::sqrt(length);
    }
  EXPECT_GT(moving, parameters.count()) << "too little to compare";
}

/// Of all values of `parameters`.
void expect_differences(const WindowParameters& parameters, int degree, double step = 1e-6,
                        const VarianceLoss& variance = {}) {
  const std::vector<float> by_image = random_gradient(2);
  const std::vector<double> gradient = reference_gradient(parameters, degree, by_image, variance);
  std::vector<double> values = values_of<double>(parameters);
  for (std::size_t k = 0; k < values.size(); ++k) {
    // Rounding / step is 1e-9 for the default. The error of central differences is step^2 times the
    // third derivative, which is large where a pixel is close to an edge (1 / rho^3). No pixel
    // crosses a limit of alpha or a bisector of the edges within such a step.
    const double middle = values[k];
    values[k] = middle + step;
    const double above = loss_of(values, parameters, degree, by_image, variance);
    values[k] = middle - step;
    const double below = loss_of(values, parameters, degree, by_image, variance);
    values[k] = middle;
    const double difference = (above - below) / (2 * step);
    EXPECT_NEAR(gradient[k], difference, 1e-6 * std::max(1.0, std::abs(difference)))
        << "row " << k % parameters.rows() << " of splat " << k / parameters.rows();
  }
}

TEST(WindowGradient, OfTheReferenceIsThatOfDifferences) {
  expect_differences(random_parameters(1, 6, 3), 3);
  expect_differences(random_parameters(1, 6, 3, 4), 3);      // many pixels reach the largest alpha
  expect_differences(random_parameters(5, 4, 1, 0, 1), 1);   // peaked
  expect_differences(random_parameters(6, 4, 1, 0, -3), 1);  // nearly opaque inside
  WindowParameters floored = random_parameters(7, 4, 1);
  floored.solidity = 0.4f;
  expect_differences(floored, 1);
  const VarianceLoss variance{.weight = variance_like_noise};
  expect_differences(floored, 1, 1e-6, variance);
  floored.solidity = 0.9999f;
  expect_differences(floored, 1, 1e-6, variance);
}

TEST(WindowGradient, OfTheReferenceBelongsToTheImageOfTheOracle) {
  const WindowParameters parameters = random_parameters(3, 40, 3, 1);
  Scene scene;
  scene.layers.push_back({.primitives = parameters.splats()});
  const OracleImage expected = render_oracle(
      scene, {camera()}, {.background = glm::vec3(background[0], background[1], background[2])});
  const std::vector<double> image = image_of(values_of<double>(parameters), parameters, 3);
  for (std::size_t pixel = 0; pixel < expected.color.pixels.size(); ++pixel)
    for (std::size_t c = 0; c < 3; ++c)
      // Sigmas and opacities are rounded to floats before the oracle draws.
      EXPECT_NEAR(std::clamp(image[c * width * height + pixel], 0.0, 1.0),
                  expected.color.pixels[pixel][int(c)], 1e-5);
}

TEST(WindowGradient, ImagesOfTheKernelsAreThoseOfTheReference) {
  const WindowParameters parameters = random_parameters(4, 40, 3, 1);
  ThreadPool pool(1);
  TileRaster<WindowTraining> raster(pool);
  std::vector<float> planes(3 * width * height);
  raster.forward(parameters, camera(), 3, background, planes);
  const std::vector<double> image = image_of(values_of<double>(parameters), parameters, 3);
  for (std::size_t k = 0; k < planes.size(); ++k)
    EXPECT_NEAR(double(planes[k]), image[k], 2e-5);  // rounding; no splat is near a limit here
}

TEST(WindowGradient, OfTheKernelsIsThatOfTheReference) {
  for (std::uint64_t seed = 10; seed < 14; ++seed)
    expect_agreement(random_parameters(seed, 9, 3), 3, seed);
}

/// More splats than a batch in each block, which reach the stop. With so small a sigma, pixels
/// nearer to an edge than 0.001 count.
TEST(WindowGradient, HoldsBehindManySplats) {
  expect_agreement(random_parameters(20, 60, 1, 2.5, -2), 1, 20, 1e-3);
}

TEST(WindowGradient, HoldsWhereAlphaIsLimited) {
  expect_agreement(random_parameters(21, 12, 0, 6, -2), 0, 21);
}

TEST(WindowGradient, HoldsForPeaksAndForNearlyOpaqueWindows) {
  expect_agreement(random_parameters(25, 9, 1, 1, 1.2), 1, 25);
  expect_agreement(random_parameters(26, 9, 1, 1, -4), 1, 26);
}

/// Windows of ordinary size, and some smaller than the ramp.
TEST(WindowGradient, HoldsWhileTrianglesBecomeSolid) {
  for (const float solidity : {0.4f, 0.9999f})
    for (const float weight : {0.0f, variance_like_noise}) {
      WindowParameters parameters = random_parameters(27, 12, 1);
      for (std::size_t k = 0; k < 9; ++k)
        for (std::size_t i = 9; i < 12; ++i) parameters.trained(row::corners + k)[i] *= 0.05f;
      parameters.solidity = solidity;
      for (std::size_t i = 0; i < 12; ++i) parameters.activate(i);
      expect_agreement(parameters, 1, 27, 3e-4, {.weight = weight});
    }
}

/// The loss is that of the other pixels.
TEST(WindowGradient, OfTheVarianceOmitsIgnoredPixels) {
  WindowParameters parameters = random_parameters(30, 9, 1);
  parameters.solidity = 0.7f;
  for (std::size_t i = 0; i < 9; ++i) parameters.activate(i);
  std::vector<std::uint8_t> left_half(width * height);
  for (std::size_t pixel = 0; pixel < left_half.size(); ++pixel)
    left_half[pixel] = pixel % width < width / 2;
  expect_agreement(parameters, 1, 30, 3e-4, {variance_like_noise, left_half});
}

/// Of the harmonics of lower degrees only, if only those are drawn.
TEST(WindowGradient, HoldsForFewerDegrees) {
  for (int degree = 0; degree < 3; ++degree)
    expect_agreement(random_parameters(22, 6, 3), degree, 22);
}

/// One corner, then two, behind the eye, whose centre is in front of it.
TEST(WindowGradient, HoldsWithCornersBehindTheEye) {
  WindowParameters parameters = random_parameters(28, 6, 1, 0);
  const auto set_corner = [&](std::size_t splat, std::size_t k, glm::vec3 at) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      parameters.trained(row::corners + 3 * k + axis)[splat] = at[int(axis)];
  };
  set_corner(0, 0, {0.5f, -0.2f, 4.6f});
  set_corner(1, 0, {0.6f, 0.3f, 4.3f});
  set_corner(1, 2, {-0.5f, 0.1f, 4.4f});
  expect_differences(parameters, 1, 2e-7);  // third derivatives are larger near the eye
  expect_agreement(parameters, 1, 28);
  parameters.solidity = 0.8f;
  for (std::size_t i = 0; i < 6; ++i) parameters.activate(i);
  expect_agreement(parameters, 1, 28);
}

TEST(WindowGradient, OfLimitedColorsAndHiddenSplatsIsZero) {
  WindowParameters parameters = random_parameters(23, 3, 0);
  parameters.trained(row::harmonics)[0] = -5;  // no red
  for (std::size_t k = 0; k < 3; ++k)
    parameters.trained(row::corners + 3 * k + 2)[1] = 3.9f;  // nearer than the smallest depth
  parameters.trained(row::opacity)[2] = -9;                  // below the smallest alpha
  for (std::size_t i = 0; i < 3; ++i) parameters.activate(i);
  const std::vector<float> gradient = kernel_gradient(parameters, 0, random_gradient(1));
  const std::size_t rows = parameters.rows();
  EXPECT_EQ(gradient[row::harmonics], 0);
  EXPECT_NE(gradient[row::harmonics + 1], 0);
  for (std::size_t k = rows; k < gradient.size(); ++k) EXPECT_EQ(gradient[k], 0) << k;
  expect_agreement(parameters, 0, 23);
}

/// A triangle whose corners are on a line, or in one point, is not drawn and has no derivative.
TEST(WindowGradient, OfTrianglesWithoutAreaIsZero) {
  WindowParameters parameters = random_parameters(29, 3, 1, 1);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto corner = [&](std::size_t k, std::size_t splat) -> float& {
      return parameters.trained(row::corners + 3 * k + axis)[splat];
    };
    corner(1, 0) = corner(0, 0);
    corner(2, 0) = corner(0, 0);
    corner(1, 1) = corner(0, 1);
  }
  const std::vector<float> gradient = kernel_gradient(parameters, 1, random_gradient(1));
  const std::size_t rows = parameters.rows();
  for (std::size_t k = 0; k < 2 * rows; ++k) EXPECT_EQ(gradient[k], 0) << k;
  EXPECT_NE(gradient[2 * rows + row::opacity], 0);
}

/// The derivatives on both sides of each limit are those of one-sided differences, in the reference
/// and in the kernels.
class WindowBranch : public testing::Test {
 protected:
  /// Large windows across the view, the first one in front.
  static WindowParameters facing(std::size_t count) {
    WindowParameters parameters(count, 0);
    for (std::size_t i = 0; i < count; ++i) {
      const float z = 0.5f - float(i);
      const float corners[9] = {-2.2f, -1.4f, z, 2.0f, -1.7f, z, 0.2f, 2.6f, z};
      for (std::size_t k = 0; k < 9; ++k) parameters.trained(row::corners + k)[i] = corners[k];
      parameters.trained(row::sigma)[i] = -1;
      parameters.trained(row::harmonics)[i] = 0.3f;
      parameters.trained(row::harmonics + 1)[i] = -0.4f * float(i);
      parameters.activate(i);
    }
    return parameters;
  }

  /// Where only this pixel matters.
  static std::vector<float> by_pixel() {
    std::vector<float> result(3 * width * height);
    for (std::size_t c = 0; c < 3; ++c) result[c * width * height + 9 * width + 10] = 1 + float(c);
    return result;
  }

  static double alpha_at_pixel(const WindowParameters& parameters, std::size_t splat) {
    const std::vector<double> values = values_of<double>(parameters);
    const auto window = test::reference_window(&values[splat * parameters.rows()], 0, camera(), 0);
    return window.opacity * std::pow(window.rho(10.5, 9.5), window.sigma);
  }

  /// Sets the opacity so that alpha at the pixel has this value.
  static void set_alpha(WindowParameters& parameters, std::size_t splat, double alpha) {
    for (int iteration = 0; iteration < 60; ++iteration) {
      const double now = alpha_at_pixel(parameters, splat);
      const double opacity = 1 / (1 + std::exp(-double(parameters.trained(row::opacity)[splat])));
      const double next = std::min(opacity * alpha / now, 1 - 1e-9);
      parameters.trained(row::opacity)[splat] = float(std::log(next / (1 - next)));
    }
    parameters.activate(splat);
  }

  /// `value` is just beside the limit; a step of the sign `side` leads away from it. Compares the
  /// derivative of the reference with a one-sided difference of the second order, and the kernels'.
  static void expect_one_sided(const WindowParameters& parameters, std::size_t splat, std::size_t r,
                               double side) {
    const std::vector<float> by_image = by_pixel();
    const std::vector<double> gradient = reference_gradient(parameters, 0, by_image);
    const std::vector<float> kernels = kernel_gradient(parameters, 0, by_image);
    std::vector<double> values = values_of<double>(parameters);
    const std::size_t index = splat * parameters.rows() + r;
    const double step = 1e-6 * side, middle = values[index];
    double at[3];
    for (int k = 0; k < 3; ++k) {
      values[index] = middle + k * step;
      at[k] = loss_of(values, parameters, 0, by_image, {});
    }
    const double difference = (-3 * at[0] + 4 * at[1] - at[2]) / (2 * step);
    EXPECT_NEAR(gradient[index], difference, 1e-6 * std::max(1.0, std::abs(difference))) << side;
    // Single precision, relative to the largest derivative of the splat.
    double largest = 0;
    for (std::size_t k = 0; k < parameters.rows(); ++k)
      largest = std::max(largest, std::abs(gradient[splat * parameters.rows() + k]));
    EXPECT_NEAR(double(kernels[index]), gradient[index], 1e-4 * largest + 1e-7) << side;
  }
};

TEST_F(WindowBranch, AtTheLargestAlpha) {
  double slopes[2];
  for (const int side : {-1, 1}) {
    WindowParameters parameters = facing(1);
    parameters.trained(row::sigma)[0] = -5;
    set_alpha(parameters, 0, 0.99 + side * 2e-6);
    expect_one_sided(parameters, 0, row::opacity, side);
    expect_one_sided(parameters, 0, row::sigma, -side);  // a larger sigma lowers alpha
    slopes[side > 0] = reference_gradient(parameters, 0, by_pixel())[row::opacity];
  }
  EXPECT_NE(slopes[0], 0);
  EXPECT_EQ(slopes[1], 0);
}

TEST_F(WindowBranch, AtTheSmallestAlpha) {
  double slopes[2];
  for (const int side : {-1, 1}) {
    WindowParameters parameters = facing(1);
    set_alpha(parameters, 0, (1 + side * 2e-5) / 255);
    expect_one_sided(parameters, 0, row::opacity, side);
    expect_one_sided(parameters, 0, row::corners + 1, -side);
    slopes[side > 0] = reference_gradient(parameters, 0, by_pixel())[row::opacity];
  }
  EXPECT_EQ(slopes[0], 0);
  EXPECT_NE(slopes[1], 0);
}

/// The last of three windows lowers the transmittance to just above the stop or just below it.
TEST_F(WindowBranch, AtTheStop) {
  double slopes[2];
  for (const int side : {-1, 1}) {
    WindowParameters parameters = facing(3);
    for (std::size_t i = 0; i < 3; ++i) {
      parameters.trained(row::sigma)[i] = -5;
      parameters.trained(row::corners + 2)[i] = 0.5f - 0.2f * float(i);
    }
    set_alpha(parameters, 0, 0.95);
    set_alpha(parameters, 1, 0.9);
    const double left = (1 - alpha_at_pixel(parameters, 0)) * (1 - alpha_at_pixel(parameters, 1));
    set_alpha(parameters, 2, 1 - 1e-4 * (1 - side * 1e-3) / left);
    expect_one_sided(parameters, 2, row::opacity, side);
    expect_one_sided(parameters, 0, row::opacity, side);
    expect_one_sided(parameters, 1, row::harmonics, side);
    slopes[side > 0] =
        reference_gradient(parameters, 0, by_pixel())[2 * parameters.rows() + row::opacity];
  }
  EXPECT_NE(slopes[0], 0);
  EXPECT_EQ(slopes[1], 0);
}

/// The part of a window before the near plane is not drawn. The pixel's ray meets the window just
/// beyond the near plane, or just before it.
TEST_F(WindowBranch, AtTheNearPlane) {
  const Camera view = camera();
  const glm::dmat4 world_from_view = glm::inverse(view.view_from_world);
  Random random(5);
  WindowParameters parameters = facing(1);
  glm::dvec3 edges[2];  // from the point on the ray to the first two corners; the third is opposite
  double slopes[2];
  bool found = false;
  // Such a plane passes the eye at less than 0.001: few triangles face the eye there.
  for (int attempt = 0; attempt < 1000 && !found; ++attempt) {
    for (glm::dvec3& edge : edges) edge = random.uniform(0.3, 2) * random.direction();
    for (const int side : {-1, 1}) {
      // 1 % from the near plane: single precision resolves the depth to 0.01 % among lengths of 1.
      const double depth = test::reference_near * (1 + side * 1e-2);
      const glm::dvec3 on_ray((10.5 - view.cx) / view.fx * depth,
                              -(9.5 - view.cy) / view.fy * depth, -depth);
      const glm::dvec3 corners[3] = {edges[0], edges[1], -0.4 * (edges[0] + edges[1])};
      for (std::size_t k = 0; k < 3; ++k) {
        const glm::dvec3 world = world_from_view * glm::dvec4(on_ray + corners[k], 1);
        for (std::size_t axis = 0; axis < 3; ++axis)
          parameters.trained(row::corners + 3 * k + axis)[0] = float(world[int(axis)]);
      }
      slopes[side > 0] = reference_gradient(parameters, 0, by_pixel())[row::opacity];
      if (slopes[side > 0] == 0) continue;
      found = true;
      expect_one_sided(parameters, 0, row::opacity, 1);
      expect_one_sided(parameters, 0, row::sigma, 1);
    }
  }
  ASSERT_TRUE(found);
  EXPECT_EQ(slopes[0], 0);
  EXPECT_NE(slopes[1], 0);
}

/// A window whose centre is just beyond the smallest depth is drawn; just before, it is not.
TEST_F(WindowBranch, AtTheSmallestDepth) {
  const glm::dmat4 world_from_view = glm::inverse(camera().view_from_world);
  double slopes[2];
  for (const int side : {-1, 1}) {
    WindowParameters parameters = facing(1);
    const double depth = 0.2 * (1 + side * 1e-4);
    const glm::dvec4 corners[3] = {
        {-0.1, -0.06, -depth, 1}, {0.1, -0.08, -depth, 1}, {0.01, 0.12, -depth, 1}};
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::dvec4 world = world_from_view * corners[k];
      for (std::size_t axis = 0; axis < 3; ++axis)
        parameters.trained(row::corners + 3 * k + axis)[0] = float(world[int(axis)]);
    }
    expect_one_sided(parameters, 0, row::opacity, side);
    expect_one_sided(parameters, 0, row::corners, side);
    slopes[side > 0] = reference_gradient(parameters, 0, by_pixel())[row::opacity];
  }
  EXPECT_EQ(slopes[0], 0);
  EXPECT_NE(slopes[1], 0);
}

TEST(WindowGradient, OfTheWindowsThemselvesIsThatOfDifferences) {
  const WindowParameters parameters = random_parameters(40, 5, 0);
  const WindowLoss loss{.opacity = 0.7f, .sigma = 0.4f, .inverse_area = 0.01f};
  const std::vector<float> nothing(3 * width * height);
  const std::vector<float> actual = kernel_gradient(parameters, 0, nothing, 1, loss);
  const std::size_t rows = parameters.rows();
  const auto loss_of_splat = [&](const double* p) {
    const auto corner = [&](std::size_t k) {
      return glm::dvec3(p[3 * k], p[3 * k + 1], p[3 * k + 2]);
    };
    const double area = 0.5 * glm::length(glm::cross(corner(1) - corner(0), corner(2) - corner(0)));
    return double(loss.opacity) / (1 + std::exp(-p[row::opacity])) +
           double(loss.sigma) * std::exp(p[row::sigma]) + double(loss.inverse_area) / area;
  };
  std::vector<double> values = values_of<double>(parameters);
  for (std::size_t i = 0; i < parameters.count(); ++i)
    for (std::size_t r = 0; r < row::harmonics; ++r) {
      double& value = values[i * rows + r];
      const double middle = value;
      value = middle + 1e-6;
      const double above = loss_of_splat(&values[i * rows]);
      value = middle - 1e-6;
      const double below = loss_of_splat(&values[i * rows]);
      value = middle;
      const double difference = (above - below) / 2e-6;
      // Single precision.
      EXPECT_NEAR(double(actual[i * rows + r]), difference,
                  1e-5 * std::max(1.0, std::abs(difference)))
          << "row " << r << " of splat " << i;
    }
}

TEST(WindowGradient, HasTheSameBitsWithMoreThreads) {
  const WindowParameters parameters = random_parameters(30, 500, 2);
  const std::vector<float> by_image = random_gradient(30);
  const std::vector<float> one = kernel_gradient(parameters, 2, by_image, 1);
  for (const int threads : {2, 5}) {
    const std::vector<float> more = kernel_gradient(parameters, 2, by_image, threads);
    EXPECT_EQ(std::memcmp(one.data(), more.data(), one.size() * sizeof(float)), 0) << threads;
  }
}

/// One splat that is not finite neither moves nor stops the others.
TEST(WindowGradient, ThatIsNotFiniteIsQuarantined) {
  WindowParameters parameters = random_parameters(31, 20, 1);
  ThreadPool pool(1);
  TileRaster<WindowTraining> raster(pool);
  std::vector<float> planes(3 * width * height);
  raster.forward(parameters, camera(), 1, background, planes);
  const BackwardInput<WindowMoments> input = raster.backward(planes, random_gradient(31));
  std::vector<WindowMoments> moments(input.moments.begin(), input.moments.end());
  ASSERT_LT(input.pairs[7].begin, input.pairs[7].end);
  moments[input.pairs[7].begin].y.q[1] = std::numeric_limits<float>::quiet_NaN();
  const WindowParameters before = parameters;
  SplatMemory memory(parameters.rows(), parameters.count());
  const WindowStep step{.rates = {1e-3f, 1e-3f, 1e-3f, 1e-3f, 1e-3f}};
  const BackwardInput<WindowMoments> damaged{input.view, input.degree, input.pairs, moments};
  splatting::ParameterRows gradients(parameters.rows(), 20);
  window_step_functions().gradients(input, step, parameters, 0, 20, gradients);
  EXPECT_EQ(window_step_functions().step(damaged, step, 0, 20, parameters, memory), 1u);
  int moving = 0;
  for (std::size_t i = 0; i < 20; ++i) {
    // Some windows have a tile, but not the centre of a pixel.
    if (gradients.row(row::opacity)[i] == 0) continue;
    ++moving;
    EXPECT_EQ(parameters.trained(row::opacity)[i] == before.trained(row::opacity)[i], i == 7) << i;
    // The first step of Adam is the rate.
    if (i != 7) {
      EXPECT_NEAR(std::abs(parameters.trained(row::corners)[i] - before.trained(row::corners)[i]),
                  1e-3, 1e-6);
    }
  }
  EXPECT_GT(moving, 10);
}

}  // namespace window_gradient_test
}  // namespace tureen::trainer
