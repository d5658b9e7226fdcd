// The oracle's neural densities, against numerical integration (specs/03, sections 2, 3 and 9).
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "oracle/neural_density.hpp"
#include "oracle/oracle.hpp"
#include "tests/oracle/splats_in_view.hpp"

namespace tureen {
namespace oracle_densities_test {

using oracle::NeuralDensityInView;
using oracle::SplatView;

constexpr double near = 1e-6;
constexpr double everywhere = 1e300;
constexpr int neurons = NeuralDensities::width;

/// The cases of the table in specs/03, section 3.
struct Case {
  const char* name;
  double distance = 30;  // in largest semi-axes
  double frequency = 1;  // scales the weights
  double aspect = 3;     // of the ellipsoid
  bool is_grazing = false;
  /// Of the optical depth. The rounding of a chord of length h sqrt(discriminant) grows towards the
  /// silhouette and with the distance; Simpson's rule has about 1e-12.
  double tolerance = 1e-10;
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

NeuralDensities random_density(test::Random& random, const Case& of) {
  NeuralDensities result;
  const double largest = 0.1;
  result.centers = {glm::vec3(0, 0, float(-largest * of.distance))};
  glm::vec3 axes{float(largest)};
  for (int k = 1; k < 3; ++k) axes[k] /= float(std::pow(of.aspect, random.uniform()));
  if (of.aspect > 10) axes[1] = axes[0] / float(of.aspect);
  result.semi_axes = {axes};
  result.rotations = {test::random_rotation(random)};
  for (int k = 0; k < 4 * neurons; ++k)
    result.networks.push_back(float(of.frequency * random.uniform(-1.0 / 3, 1.0 / 3)));
  for (int k = 0; k < neurons; ++k) result.networks.push_back(float(random.uniform(-2, 2)));
  result.networks.push_back(float(random.uniform(1, 4)));
  return result;
}

/// The density at a point in layer coordinates, from its definition (scene/splats.hpp).
double density_at(const NeuralDensities& d, const glm::dvec3& point) {
  const glm::dvec3 axes(d.semi_axes[0]);
  const glm::dvec3 u = (point - glm::dvec3(d.centers[0])) / std::max({axes.x, axes.y, axes.z});
  double value = d.networks[5 * neurons];
  for (int k = 0; k < neurons; ++k) {
    const glm::dvec3 w(d.networks[3 * k], d.networks[3 * k + 1], d.networks[3 * k + 2]);
    value += double(d.networks[4 * neurons + k]) *
             std::cos(double(d.omega) * (glm::dot(w, u) + double(d.networks[3 * neurons + k])));
  }
  return value;
}

bool is_inside(const NeuralDensities& d, const glm::dvec3& point) {
  const glm::dmat3 axes = glm::mat3_cast(glm::normalize(glm::dquat(d.rotations[0])));
  const glm::dvec3 local = (point - glm::dvec3(d.centers[0])) * axes / glm::dvec3(d.semi_axes[0]);
  return glm::dot(local, local) < 1;
}

/// The depth in [from, to] at which a ray from the origin enters or leaves the ellipsoid.
double crossing(const NeuralDensities& d, const glm::dvec3& ray, double from, double to) {
  const bool at_start = is_inside(d, from * ray);
  for (int i = 0; i < 200; ++i) {
    const double middle = (from + to) / 2;
    (is_inside(d, middle * ray) == at_start ? from : to) = middle;
  }
  return (from + to) / 2;
}

/// The optical depth between two depths inside the ellipsoid, by Simpson's rule.
double simpson(const NeuralDensities& d, const glm::dvec3& ray, double from, double to) {
  constexpr int steps = 20000;
  double sum = 0;
  for (int i = 0; i <= steps; ++i) {
    const double weight = i == 0 || i == steps ? 1 : i % 2 == 1 ? 4 : 2;
    sum += weight * density_at(d, (from + (to - from) * i / steps) * ray);
  }
  const glm::dvec3 axes(d.semi_axes[0]);
  return sum / 3 * (to - from) / steps * glm::length(ray) / std::max({axes.x, axes.y, axes.z});
}

class OracleDensities : public testing::TestWithParam<Case> {};

TEST_P(OracleDensities, EqualNumericalIntegration) {
  const Case& of = GetParam();
  test::Random random(5);
  // The image shows the ellipsoid about 100 px wide at any distance.
  const Camera camera = test::straight_camera(200, 200, 50 * of.distance);
  const SplatView view(glm::dmat4(1.0), camera, near);
  int compared = 0;
  double largest_error = 0;
  for (int i = 0; i < 300 && compared < 60; ++i) {
    const NeuralDensities d = random_density(random, of);
    const auto splat = NeuralDensityInView::project(d, 0, {}, view);
    ASSERT_TRUE(splat);
    // A point inside, and the ray through it.
    const glm::dmat3 axes = glm::mat3_cast(glm::normalize(glm::dquat(d.rotations[0])));
    const double radius =
        of.is_grazing ? 1 - std::pow(10, random.uniform(-6, -2)) : std::cbrt(random.uniform());
    const glm::dvec3 point = glm::dvec3(d.centers[0]) +
                             axes * (radius * random.direction() * glm::dvec3(d.semi_axes[0]));
    const glm::dvec2 pixel(100 - camera.fx * point.x / point.z,
                           100 + camera.fy * point.y / point.z);
    const glm::dvec3 ray = test::point_at(camera, pixel, 1);
    const double inside = -point.z, size = 0.3;
    const double enters = crossing(d, ray, inside - size, inside);
    const double leaves = crossing(d, ray, inside, inside + size);
    const double expected = simpson(d, ray, enters, leaves);
    double middle = 0;
    const double actual = splat->optical_depth(pixel, near, everywhere, middle);
    largest_error = std::max(largest_error, std::abs(actual - expected));
    EXPECT_NEAR(middle, (enters + leaves) / 2, 1e-9);
    // Cut in front, and cut by an opaque surface.
    const double cut = enters + 0.4 * (leaves - enters);
    const double front = splat->optical_depth(pixel, near, cut, middle);
    EXPECT_NEAR(middle, (enters + cut) / 2, 1e-9);
    largest_error = std::max(largest_error, std::abs(front - simpson(d, ray, enters, cut)));
    const double rear = splat->optical_depth(pixel, cut, everywhere, middle);
    largest_error = std::max(largest_error, std::abs(front + rear - actual));
    ++compared;
  }
  RecordProperty("largest_error", std::to_string(largest_error));
  EXPECT_LT(largest_error, of.tolerance);
}

INSTANTIATE_TEST_SUITE_P(
    Cases, OracleDensities,
    testing::Values(Case{"typical"}, Case{"slow", 30, 1e-5}, Case{"constant", 30, 0},
                    Case{"fast", 30, 10}, Case{"very_fast", 30, 100, 3, false, 1e-8},
                    Case{"grazing", 30, 1, 3, true}, Case{"aspect_1000", 30, 1, 1000},
                    Case{"far", 1e3, 1, 3, false, 1e-9}, Case{"very_far", 1e4, 1, 3, false, 1e-8}));

OracleImage image_of(const NeuralDensities& d, const Camera& camera,
                     const glm::dmat4& world_from_layer = glm::dmat4(1.0)) {
  Scene scene = scene_of(Splats{d, test::flat_colors({{1, 0.5f, 0.25f}}), {}});
  scene.layers[0].world_from_layer = world_from_layer;
  return render_oracle(scene, {camera});
}

double largest_difference(const OracleImage& a, const OracleImage& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.splat_alpha.size(); ++i)
    largest = std::max(largest, std::abs(a.splat_alpha[i] - b.splat_alpha[i]));
  return largest;
}

/// How many rays the splats cover by more than 10 %.
int covered(const OracleImage& image) {
  return int(std::count_if(image.splat_alpha.begin(), image.splat_alpha.end(),
                           [](double alpha) { return alpha > 0.1; }));
}

class OracleDensity : public testing::Test {
 protected:
  test::Random random_{8};
  Camera camera_ = test::straight_camera(80, 60, 600);
  NeuralDensities density_ = random_density(random_, {"", 30});
};

// The density is a function of layer axes: an edit that turns an ellipsoid turns its weights too.
TEST_F(OracleDensity, TurnsWithItsRotationAndWeights) {
  const OracleImage straight = image_of(density_, camera_);
  ASSERT_GT(covered(straight), 100);
  const glm::dquat turn = glm::angleAxis(0.7, glm::dvec3(0, 0, 1));
  NeuralDensities turned = density_;
  turned.rotations[0] = glm::quat(turn * glm::dquat(density_.rotations[0]));
  for (int k = 0; k < neurons; ++k) {
    const glm::dvec3 w(density_.networks[3 * k], density_.networks[3 * k + 1],
                       density_.networks[3 * k + 2]);
    const glm::dvec3 v = turn * w;
    for (int c = 0; c < 3; ++c) turned.networks[3 * k + c] = float(v[c]);
  }
  Camera rolled = camera_;
  rolled.view_from_world = glm::dmat4(glm::mat3_cast(glm::inverse(turn)));
  // The turned parameters are rounded to float: 6e-8 times a phase of up to 10, and its square root
  // at the silhouette, where alpha may jump below 1/255.
  EXPECT_LT(largest_difference(straight, image_of(turned, rolled)), 5e-3);
  EXPECT_GT(largest_difference(straight, image_of(turned, camera_)), 0.05);
}

TEST_F(OracleDensity, DoesNotDependOnItsScale) {
  const OracleImage original = image_of(density_, camera_);
  NeuralDensities large = density_;
  large.centers[0] *= 1024.0f;
  large.semi_axes[0] *= 1024.0f;
  // A power of 2 keeps all digits.
  EXPECT_LT(largest_difference(original, image_of(large, camera_)), 1e-12);
  // The same by the layer's place, in front of the same camera.
  EXPECT_LT(largest_difference(original, image_of(density_, camera_,
                                                  glm::scale(glm::dmat4(1.0), glm::dvec3(5.0)))),
            1e-10);
}

TEST_F(OracleDensity, WithTheCameraInsideStartsAtTheNearPlane) {
  density_.centers[0] = glm::vec3(0.02f, 0, 0.01f);
  density_.semi_axes[0] = glm::vec3(0.1f, 0.15f, 0.2f);
  const Camera camera = test::straight_camera(40, 30, 20);
  const SplatView view(glm::dmat4(1.0), camera, near);
  const auto splat = NeuralDensityInView::project(density_, 0, {}, view);
  ASSERT_TRUE(splat);
  for (int y = 0; y < 30; y += 5)
    for (int x = 0; x < 40; x += 5) {
      const glm::dvec2 pixel(x + 0.5, y + 0.5);
      const glm::dvec3 ray = test::point_at(camera, pixel, 1);
      const double expected = simpson(density_, ray, near, crossing(density_, ray, near, 1));
      double middle = 0;
      EXPECT_NEAR(splat->optical_depth(pixel, near, everywhere, middle), expected, 1e-10);
    }
}

TEST_F(OracleDensity, BelowZeroIsInvisible) {
  std::fill(density_.networks.begin(), density_.networks.end(), 0.0f);
  density_.networks.back() = -2;
  EXPECT_EQ(covered(image_of(density_, camera_)), 0);
  density_.networks.back() = 1e6f;  // N15
  const OracleImage opaque = image_of(density_, camera_);
  EXPECT_NEAR(*std::max_element(opaque.splat_alpha.begin(), opaque.splat_alpha.end()), 0.99, 1e-7);
}

}  // namespace oracle_densities_test
}  // namespace tureen
