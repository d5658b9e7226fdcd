// Gradients of neural densities: derivatives in double precision against differences and, as
// images, against the oracle; the vector kernels against these; the same bits with any number of
// threads.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>

#include "oracle/oracle.hpp"
#include "tests/support/random.hpp"
#include "tests/trainer/gradient_views.hpp"
#include "tests/trainer/neural/neural_reference.hpp"
#include "trainer/splats/neural/neural_training.hpp"

namespace tureen::trainer {
namespace neural_gradient_test {

namespace row = splatting::neural_row;
using test::background;
using test::camera;
using test::Dual;
using test::height;
using test::random_gradient;
using test::values_of;
using test::width;
using tureen::test::Random;

/// Splats in the ball of radius 1 about the origin. Frequencies have the length that training
/// reaches, about 11.
NeuralParameters random_parameters(std::uint64_t seed, std::size_t count, int degree,
                                   double mean_offset = 0.7, double mean_log_axis = -1.2) {
  Random random(seed);
  NeuralParameters result(count, degree);
  for (std::size_t i = 0; i < count; ++i) {
    const auto set = [&](std::size_t r, double value) { result.trained(r)[i] = float(value); };
    const glm::dvec3 center = random.uniform(0, 1) * random.direction();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      set(row::center + axis, center[int(axis)]);
      set(row::semi_axes + axis, mean_log_axis + 0.6 * random.normal());
    }
    for (std::size_t k = 0; k < 4; ++k) set(row::rotation + k, 1.7 * random.normal());
    for (std::size_t r = row::frequencies; r < row::phases; ++r) set(r, 6 * random.normal());
    for (std::size_t r = row::phases; r < row::amplitudes; ++r) set(r, random.uniform(-10, 10));
    for (std::size_t r = row::amplitudes; r < row::offset; ++r) set(r, random.normal());
    set(row::offset, mean_offset + 0.5 * random.normal());
    for (std::size_t r = row::harmonics; r < result.rows(); ++r) set(r, 0.25 * random.normal());
    result.activate(i);
  }
  return result;
}

template <class Real>
std::vector<Real> image_of(const std::vector<Real>& values, std::size_t rows, int degree,
                           test::Branches* branches = nullptr) {
  return test::reference_density_image(values, rows, degree, camera(), background, branches);
}

std::vector<double> reference_gradient(const NeuralParameters& parameters, int degree,
                                       const std::vector<float>& by_image) {
  return test::slopes_of(values_of<Dual>(parameters), [&](const std::vector<Dual>& values) {
    return test::sum_of(image_of(values, parameters.rows(), degree), by_image);
  });
}

/// Of the kernels, splat after splat.
std::vector<float> kernel_gradient(const NeuralParameters& parameters, int degree,
                                   const std::vector<float>& gradient, int threads = 1,
                                   float anisotropy = 0) {
  ThreadPool pool(threads);
  TileRaster<NeuralTraining> raster(pool);
  std::vector<float> planes(gradient.size());
  raster.forward(parameters, camera(), degree, background, planes);
  const auto input = raster.backward(planes, gradient);
  splatting::ParameterRows rows(parameters.rows(), parameters.count());
  neural_step_functions().gradients(
      input, {.rates = {}, .min_log_axis = -20, .max_log_axis = 20, .anisotropy = anisotropy},
      parameters, 0, parameters.count(), rows);
  std::vector<float> result;
  for (std::size_t i = 0; i < parameters.count(); ++i)
    for (std::size_t r = 0; r < parameters.rows(); ++r) result.push_back(rows.row(r)[i]);
  return result;
}

/// Single precision gives about 1e-5 through the phases, which reach 30, and the sums over pixels.
/// Derivatives by centres have the factor of the frequencies, about 10.
void expect_agreement(const NeuralParameters& parameters, int degree, std::uint64_t seed) {
  const std::vector<float> by_image = random_gradient(seed);
  test::expect_close(neural_parameter_kinds, parameters.rows(),
                     kernel_gradient(parameters, degree, by_image),
                     reference_gradient(parameters, degree, by_image), 3e-4, 3e-5, seed);
}

TEST(NeuralGradient, OfTheReferenceIsThatOfDifferences) {
  for (const double offset : {0.7, 6.0}) {  // with 6, many pixels reach the largest alpha
    const NeuralParameters parameters = random_parameters(1, 6, 3, offset);
    const std::vector<float> by_image = random_gradient(2);
    const auto loss = [&](const auto& values) {
      return test::sum_of(image_of(values, parameters.rows(), 3), by_image);
    };
    test::expect_differences<long double>(values_of<double>(parameters),
                                          reference_gradient(parameters, 3, by_image),
                                          parameters.rows(), loss, 1e-9);
  }
}

/// Of the scans that `scan_all` makes. At the silhouette, at optical depths of 0, at the smallest
/// and largest alpha, at the near plane and at equal largest semi-axes, the derivative is that of
/// one-sided differences. Near the silhouette, where alpha is like a square root, they need small
/// steps.
std::string branches_met(const NeuralParameters& parameters, double step, const auto& scan_all) {
  const std::vector<float> by_image = random_gradient(8);
  auto scan = test::branch_scan<long double>(
      values_of<double>(parameters), step, [&](const auto& values, test::Branches& branches) {
        return test::sum_of(image_of(values, parameters.rows(), 0, &branches), by_image);
      });
  scan_all(scan);
  return scan.met();
}

void expect_branches(const std::string& met, std::string_view wanted) {
  for (const char branch : wanted) EXPECT_NE(met.find(branch), std::string::npos) << branch;
}

TEST(NeuralGradient, OfTheReferenceHoldsAtBranches) {
  const NeuralParameters parameters = random_parameters(7, 3, 0, 1, -1);
  const std::size_t rows = parameters.rows();
  const std::string met = branches_met(parameters, 3e-11, [&](auto& scan) {
    for (std::size_t first = 0; first < 2 * rows; first += rows) {
      scan.scan(first + row::offset, -3, 8, 20);
      for (std::size_t axis = 0; axis < 3; ++axis)
        scan.scan(first + row::semi_axes + axis, -3, 1, 8);
    }
    const auto axis_of = [&](std::size_t axis) {
      return double(parameters.trained(row::semi_axes + axis % 3)[0]);
    };
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double equal = std::max(axis_of(axis + 1), axis_of(axis + 2));
      scan.scan(row::semi_axes + axis, equal - 1e-5, equal + 1e-5, 1);
    }
  });
  expect_branches(met, "ogamsxyz");
}

/// The eye comes into an ellipsoid that covers the whole image, and beyond the smallest depth of
/// its centre.
TEST(NeuralGradient, OfTheReferenceHoldsAtTheNearPlane) {
  NeuralParameters parameters = random_parameters(9, 1, 0, 0.7, 0.4);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    parameters.trained(row::semi_axes + axis)[0] = 0.3f + 0.1f * float(axis);
    parameters.trained(row::center + axis)[0] = axis == 1 ? -0.3f : 0.3f;
  }
  // Optical depths stay between the limits of alpha.
  for (std::size_t r = row::amplitudes; r < row::offset; ++r) parameters.trained(r)[0] *= 0.1f;
  parameters.trained(row::offset)[0] = 1;
  parameters.activate(0);
  const std::string met = branches_met(parameters, 3e-10, [](auto& scan) {
    scan.scan(row::center + 2, 2, 2.9, 8);
    scan.scan(row::center + 2, 3.5, 4, 2);
  });
  expect_branches(met, "nk");
}

TEST(NeuralGradient, OfTheReferenceBelongsToTheImageOfTheOracle) {
  const NeuralParameters parameters = random_parameters(3, 40, 3);
  Scene scene;
  scene.layers.push_back({.primitives = parameters.splats()});
  const OracleImage expected = render_oracle(
      scene, {camera()}, {.background = glm::vec3(background[0], background[1], background[2])});
  const std::vector<double> image = image_of(values_of<double>(parameters), parameters.rows(), 3);
  for (std::size_t pixel = 0; pixel < expected.color.pixels.size(); ++pixel)
    for (std::size_t c = 0; c < 3; ++c)
      // Semi-axes, rotations and networks are rounded to floats before the oracle draws.
      EXPECT_NEAR(std::clamp(image[c * width * height + pixel], 0.0, 1.0),
                  expected.color.pixels[pixel][int(c)], 2e-5);
}

TEST(NeuralGradient, ImagesOfTheKernelsAreThoseOfTheReference) {
  const NeuralParameters parameters = random_parameters(4, 40, 3);
  ThreadPool pool(1);
  TileRaster<NeuralTraining> raster(pool);
  std::vector<float> planes(3 * width * height);
  raster.forward(parameters, camera(), 3, background, planes);
  const std::vector<double> image = image_of(values_of<double>(parameters), parameters.rows(), 3);
  for (std::size_t k = 0; k < image.size(); ++k)
    EXPECT_NEAR(double(planes[k]), image[k], 5e-5);  // rounding of phases
}

TEST(NeuralGradient, OfTheKernelsIsThatOfTheReference) {
  for (std::uint64_t seed = 10; seed < 12; ++seed)
    expect_agreement(random_parameters(seed, 7, 3), 3, seed);
}

/// More splats than a batch in each block, which reach the stop.
TEST(NeuralGradient, HoldsBehindManySplats) {
  expect_agreement(random_parameters(20, 20, 0, 2), 0, 20);
}

TEST(NeuralGradient, HoldsWhereAlphaIsLimited) {
  expect_agreement(random_parameters(21, 12, 0, 6), 0, 21);
}

TEST(NeuralGradient, HoldsForFewerDegrees) {
  for (int degree = 0; degree < 3; ++degree)
    expect_agreement(random_parameters(22, 6, 3), degree, 22);
}

/// Constant densities, whose frequencies along the ray are 0, and slow ones.
TEST(NeuralGradient, HoldsForSmallFrequencies) {
  NeuralParameters parameters = random_parameters(23, 6, 0);
  for (std::size_t r = row::frequencies; r < row::phases; ++r)
    for (std::size_t i = 0; i < 6; ++i) parameters.trained(r)[i] *= i < 3 ? 0.0f : 1e-3f;
  expect_agreement(parameters, 0, 23);
}

/// The near plane cuts the chords of an ellipsoid around the eye.
TEST(NeuralGradient, HoldsAroundTheEye) {
  NeuralParameters parameters = random_parameters(24, 2, 1);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    parameters.trained(row::semi_axes + axis)[0] = 0.3f + 0.1f * float(axis);
    parameters.trained(row::center + axis)[0] = axis == 2 ? 3.1f : 0.1f;
  }
  for (std::size_t i = 0; i < 2; ++i) parameters.activate(i);
  expect_agreement(parameters, 1, 24);
}

/// Aspects of 30, in both directions.
TEST(NeuralGradient, HoldsForNeedlesAndPlates) {
  NeuralParameters parameters = random_parameters(25, 8, 0);
  for (std::size_t i = 0; i < 8; ++i) {
    parameters.trained(row::semi_axes)[i] += i < 4 ? 1.5f : -2;
    for (std::size_t axis = 1; axis < 3; ++axis)
      parameters.trained(row::semi_axes + axis)[i] += i < 4 ? -1.5f : 0.5f;
    parameters.activate(i);
  }
  expect_agreement(parameters, 0, 25);
}

TEST(NeuralGradient, OfBallsIsThatOfTheFirstOfEqualAxes) {
  NeuralParameters parameters = random_parameters(26, 6, 0);
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t axis = 1; axis < 3; ++axis)
      parameters.trained(row::semi_axes + axis)[i] = parameters.trained(row::semi_axes)[i];
    parameters.activate(i);
  }
  expect_agreement(parameters, 0, 26);
}

TEST(NeuralGradient, OfAnisotropyIsThatOfDifferences) {
  const NeuralParameters parameters = random_parameters(27, 6, 0);
  const std::vector<float> by_image(3 * width * height);
  const std::vector<float> gradient = kernel_gradient(parameters, 0, by_image, 1, 0.5f);
  const auto deviation = [](const std::vector<double>& logs) {
    const double least = std::exp(std::min({logs[0], logs[1], logs[2]}));
    double mean = 0, sum = 0;
    for (const double each : logs) mean += std::exp(each) / least / 3;
    for (const double each : logs) sum += std::pow(std::exp(each) / least - mean, 2) / 2;
    return std::sqrt(sum);
  };
  for (std::size_t i = 0; i < 6; ++i) {
    std::vector<double> logs;
    for (std::size_t axis = 0; axis < 3; ++axis)
      logs.push_back(double(parameters.trained(row::semi_axes + axis)[i]));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::vector<double> above = logs, below = logs;
      above[axis] += 1e-5, below[axis] -= 1e-5;
      const double expected = 0.5 * (deviation(above) - deviation(below)) / 2e-5;
      EXPECT_NEAR(gradient[i * parameters.rows() + row::semi_axes + axis], expected,
                  1e-4 * std::max(1.0, std::abs(expected)));
    }
  }
}

TEST(NeuralGradient, HasTheSameBitsWithMoreThreads) {
  const NeuralParameters parameters = random_parameters(30, 500, 2);
  const std::vector<float> by_image = random_gradient(30);
  const std::vector<float> one = kernel_gradient(parameters, 2, by_image, 1);
  for (const int threads : {2, 5}) {
    const std::vector<float> more = kernel_gradient(parameters, 2, by_image, threads);
    EXPECT_EQ(std::memcmp(one.data(), more.data(), one.size() * sizeof(float)), 0) << threads;
  }
}

/// One splat that is not finite neither moves nor stops the others.
TEST(NeuralGradient, ThatIsNotFiniteIsQuarantined) {
  for (const std::size_t damaged : {row::harmonics, row::amplitudes, row::frequencies}) {
    NeuralParameters parameters = random_parameters(31, 20, 1);
    ThreadPool pool(1);
    TileRaster<NeuralTraining> raster(pool);
    std::vector<float> planes(3 * width * height);
    raster.forward(parameters, camera(), 1, background, planes);
    const auto input = raster.backward(planes, random_gradient(31));
    std::vector<NeuralMoments> moments(input.moments.begin(), input.moments.end());
    ASSERT_LT(input.pairs[7].begin, input.pairs[7].end);
    moments[input.pairs[7].begin]
        .values[damaged == row::harmonics    ? neural_moment::color
                : damaged == row::amplitudes ? neural_moment::amplitudes
                                             : neural_moment::frequencies] =
        std::numeric_limits<float>::quiet_NaN();
    const NeuralParameters before = parameters;
    SplatMemory memory(parameters.rows(), parameters.count());
    NeuralStep step{.rates = {}, .min_log_axis = -20, .max_log_axis = 20};
    for (float& rate : step.rates) rate = 1e-3f;
    const decltype(raster.backward({}, {})) with_nan{input.view, input.degree, input.pairs,
                                                     moments};
    EXPECT_EQ(neural_step_functions().step(with_nan, step, 0, 20, parameters, memory), 1u);
    for (std::size_t i = 0; i < 20; ++i) {
      if (input.pairs[i].begin == input.pairs[i].end) continue;
      const float moved = parameters.trained(row::center)[i] - before.trained(row::center)[i];
      // The first step of Adam is the rate, or 0 where no pixel has an optical depth.
      EXPECT_TRUE(moved == 0 || (i != 7 && std::abs(std::abs(moved) - 1e-3f) < 1e-6f)) << i;
    }
    for (std::size_t r = 0; r < parameters.rows(); ++r)
      EXPECT_EQ(parameters.trained(r)[7], before.trained(r)[7]);
  }
}

}  // namespace neural_gradient_test
}  // namespace tureen::trainer
