#include "trainer/diffsoup/initialise.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include "base/error.hpp"
#include "formats/dataset/dataset.hpp"
#include "tests/support/random_soups.hpp"
#include "tests/trainer/random_model.hpp"
#include "trainer/common/neighbours.hpp"

namespace tureen::trainer {
namespace initialise_test {

using testing::Each;
using testing::SizeIs;

Photograph view_from(glm::dvec3 eye, glm::dvec3 target, int width = 100, int height = 80) {
  return {.camera = look_at(eye, target, {0, 0, 1}, glm::radians(40.0), width, height),
          .image = {}};
}

/// Cameras at a distance from a centre, looking at it to within a tenth of a degree.
Dataset ring(std::uint64_t seed, glm::dvec3 center, double distance, int count = 40) {
  test::Random random(seed);
  Dataset dataset;
  for (int i = 0; i < count; ++i)
    dataset.train.push_back(view_from(center + distance * random.direction(),
                                      center + 1.7e-3 * distance * random.direction()));
  return dataset;
}

std::vector<DatasetPoint> ball(std::uint64_t seed, std::size_t count, glm::dvec3 center,
                               double radius) {
  Random random(seed);
  std::vector<DatasetPoint> points;
  for (std::size_t i = 0; i < count; ++i)
    points.push_back({.position = center + radius * random.in_ball(), .color = {}});
  return points;
}

// --- Random numbers

TEST(Random, RepeatsForASeedAndDiffersBetweenStreams) {
  Random a(5), b(5), other_seed(6), other_stream(5, 1);
  const std::uint64_t first = a.bits();
  EXPECT_EQ(first, b.bits());
  EXPECT_NE(first, other_seed.bits());
  EXPECT_NE(first, other_stream.bits());
}

// The numbers must not change for a seed: checked with SplitMix64 written in Python.
TEST(Random, IsSplitMix64) {
  Random random(0);
  EXPECT_EQ(random.bits(), 0xa577782bc52a9f5au);
  EXPECT_EQ(random.bits(), 0xb485244380e590beu);
}

TEST(Random, RotationsAreRotationsAndUniform) {
  Random random(71);
  glm::dmat3 sum(0.0);
  const int count = 20000;
  for (int i = 0; i < count; ++i) {
    const glm::dmat3 rotation = random.rotation();
    const glm::dmat3 square = rotation * glm::transpose(rotation);
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r) ASSERT_NEAR(square[c][r], c == r, 1e-12);
    ASSERT_NEAR(glm::determinant(rotation), 1, 1e-12);
    sum += rotation;
  }
  // Entries have mean 0 and variance 1/3: five standard errors.
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) EXPECT_NEAR(sum[c][r] / count, 0, 5 * std::sqrt(1 / 3.0 / count));
}

TEST(Random, DrawsDifferentNumbersUniformly) {
  Random random(72);
  int counts[10] = {};
  for (int i = 0; i < 10000; ++i) {
    std::vector<std::uint32_t> three = draw(random, 3, 10);
    ASSERT_THAT(three, SizeIs(3));
    for (const std::uint32_t number : three) ++counts[number];
    std::ranges::sort(three);
    ASSERT_TRUE(std::ranges::adjacent_find(three) == three.end());
  }
  for (const int count : counts)  // binomial: 3000 +- 46; the bound is five times that
    EXPECT_NEAR(count, 3000, 5 * std::sqrt(10000 * 0.3 * 0.7));
  EXPECT_THAT(draw(random, 9, 4), testing::UnorderedElementsAre(0, 1, 2, 3));
}

// --- Neighbours

TEST(Neighbours, DistancesAreThoseOfTheSlowWay) {
  test::Random random(73);
  std::vector<glm::dvec3> points;
  for (int i = 0; i < 300; ++i) points.push_back(random.direction() * random.uniform(0, 3));
  points.push_back(points[7]);  // a duplicate
  const std::vector<double> distances = nearest_distances(points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    double nearest = INFINITY;
    for (std::size_t j = 0; j < points.size(); ++j)
      if (j != i) nearest = std::min(nearest, glm::distance(points[i], points[j]));
    ASSERT_DOUBLE_EQ(distances[i], nearest);
  }
  EXPECT_EQ(distances[7], 0);
  EXPECT_THAT(nearest_distances(std::span(points).first(1)), Each(0.0));
  EXPECT_THAT(nearest_distances({}), testing::IsEmpty());
}

TEST(Neighbours, FarthestPointsAreFarFromAllBefore) {
  test::Random random(74);
  std::vector<glm::dvec3> points;
  for (int i = 0; i < 400; ++i) points.push_back(random.direction() * random.uniform(0, 3));
  const std::vector<std::uint32_t> chosen = farthest_points(points, 60, 9);
  ASSERT_THAT(chosen, SizeIs(60));
  EXPECT_EQ(chosen[0], 9u);
  const auto gap = [&](std::size_t point, std::size_t before) {
    double nearest = INFINITY;
    for (std::size_t i = 0; i < before; ++i)
      nearest = std::min(nearest, glm::distance(points[point], points[chosen[i]]));
    return nearest;
  };
  for (std::size_t i = 1; i < chosen.size(); ++i) {
    double farthest = 0;
    for (std::size_t point = 0; point < points.size(); ++point)
      farthest = std::max(farthest, gap(point, i));
    ASSERT_NEAR(gap(chosen[i], i), farthest, 1e-6) << i;  // distances are compared as floats
  }
}

TEST(Neighbours, FarthestPointsOfTwinsAreAllDifferent) {
  const std::vector<glm::dvec3> points(5, glm::dvec3(1.0));
  EXPECT_THAT(farthest_points(points, 9, 2), testing::UnorderedElementsAre(0, 1, 2, 3, 4));
}

// --- The region

TEST(Region, IsWhatTheCamerasLookAt) {
  const Region region = region_of_interest(ring(75, {5, -3, 2}, 4.0));
  EXPECT_LT(glm::distance(region.center, {5, -3, 2}), 0.01);  // axes miss the centre by 0.0017 x 4
  // The vertical field of view is 40 degrees, the horizontal one is larger.
  EXPECT_NEAR(region.half_side, 4 * std::tan(glm::radians(20.0)), 0.02);
}

TEST(Region, OfLegoIsWhereItStands) {
  const std::filesystem::path lego = TUREEN_SOURCE_DIR "/../shared/data/rendered/lego";
  if (!std::filesystem::exists(lego)) GTEST_SKIP() << "no dataset at " << lego;
  DatasetOptions options;
  options.scale = 1.0 / 16;  // only the cameras matter
  options.part = DatasetPart::train;
  const Region region = region_of_interest(read_dataset(lego, options));
  EXPECT_LT(glm::length(region.center), 1e-3);
  // Cameras of 39.6 degrees at a distance of 4.03.
  EXPECT_NEAR(region.half_side, 4.03 * std::tan(glm::radians(19.8)), 0.01);
}

TEST(Region, OfCamerasThatLookOutwardsHoldsThem) {
  test::Random random(76);
  Dataset dataset;
  for (int i = 0; i < 30; ++i) {
    const glm::dvec3 direction = random.direction();
    dataset.train.push_back(view_from(0.5 * direction, 3.0 * direction));
  }
  const Region region = region_of_interest(dataset);
  EXPECT_LT(glm::length(region.center), 0.3);
  EXPECT_NEAR(region.half_side, 1.0, 0.6);
  dataset.points = ball(77, 200, {1, 1, 1}, 10);
  // Points are more precise: half of a ball lies within 10 / cbrt(2) = 7.9 of its centre.
  EXPECT_NEAR(region_of_interest(dataset).half_side, 7.9, 1.0);
}

TEST(Region, OfParallelCamerasLiesBeforeThem) {
  Dataset dataset;
  for (int i = 0; i < 10; ++i) dataset.train.push_back(view_from({0.1 * i, 0, 0}, {0.1 * i, 5, 0}));
  const Region region = region_of_interest(dataset);
  EXPECT_NEAR(region.center.x, 0.45, 1e-9);
  EXPECT_NEAR(region.center.y, 8 * 0.45, 1e-9);
  EXPECT_GT(region.half_side, 0.5);
}

TEST(Region, OfCamerasAtOnePositionHasHalfSide1) {
  Dataset dataset;
  EXPECT_THROW(region_of_interest(dataset), InputError);
  // One camera: ahead of it, where half the image's smaller side is 1.
  dataset.train = {view_from({1, 0, 0}, {0, 0, 0})};
  const Camera& camera = dataset.train[0].camera;
  Region region = region_of_interest(dataset);
  EXPECT_DOUBLE_EQ(region.half_side, 1);
  const double depth = 1 - region.center.x;
  EXPECT_NEAR(depth * std::min(0.5 * camera.width / camera.fx, 0.5 * camera.height / camera.fy), 1,
              1e-12);
  EXPECT_NEAR(glm::length(glm::dvec2(region.center.y, region.center.z)), 0, 1e-12);
  // Twice the same camera, and the second photograph of a burst.
  dataset.train.push_back(dataset.train[0]);
  EXPECT_NEAR(glm::distance(region_of_interest(dataset).center, region.center), 0, 1e-12);
  // A panorama: around the cameras.
  dataset.train = {view_from({1, 0, 0}, {0, 0, 0}), view_from({1, 0, 0}, {0, 0, 1})};
  region = region_of_interest(dataset);
  // The positions of the cameras are computed from their matrices, with rounding.
  EXPECT_NEAR(glm::distance(region.center, glm::dvec3(1, 0, 0)), 0, 1e-12);
  EXPECT_DOUBLE_EQ(region.half_side, 1);
  // Back to back, at one position and at two.
  dataset.train = {view_from({1, 0, 0}, {0, 0, 0}), view_from({1, 0, 0}, {2, 0, 0})};
  EXPECT_DOUBLE_EQ(region_of_interest(dataset).half_side, 1);
  dataset.train = {view_from({-3, 0, 0}, {-4, 0, 0}), view_from({5, 0, 0}, {6, 0, 0})};
  region = region_of_interest(dataset);
  EXPECT_NEAR(glm::distance(region.center, glm::dvec3(1, 0, 0)), 0, 1e-12);
  EXPECT_NEAR(region.half_side, 8, 1e-12);
  // Points are more precise.
  dataset.train = {view_from({1, 0, 0}, {0, 0, 0})};
  dataset.points = ball(77, 200, {0, 0, 0}, 10);
  EXPECT_NEAR(region_of_interest(dataset).half_side, 7.9, 1.0);
}

// --- Triangles

TEST(EquilateralTriangles, HaveTheirCentersAndRadii) {
  Random random(78);
  Seeds seeds;
  for (int i = 0; i < 100; ++i) {
    seeds.centers.push_back(glm::dvec3(1000, 2000, 3000) + random.in_ball());
    seeds.radii.push_back(random.uniform(0.01, 1));
  }
  const std::vector<glm::vec3> corners = equilateral_triangles(seeds, {1000, 2000, 3000}, random);
  ASSERT_THAT(corners, SizeIs(300));
  for (std::size_t i = 0; i < 100; ++i) {
    const glm::dvec3 a(corners[3 * i]), b(corners[3 * i + 1]), c(corners[3 * i + 2]);
    const double side = std::sqrt(3.0) * seeds.radii[i];
    const double rounding = 1e-6;  // of floats below 2
    EXPECT_NEAR(glm::distance(a, b), side, rounding);
    EXPECT_NEAR(glm::distance(b, c), side, rounding);
    EXPECT_NEAR(glm::distance(c, a), side, rounding);
    const glm::dvec3 center = glm::dvec3(1000, 2000, 3000) + (a + b + c) / 3.0;
    EXPECT_LT(glm::distance(center, seeds.centers[i]), rounding);
  }
}

TEST(SeedsAtPoints, AreTwoThirdsSpreadAndOneThirdUniform) {
  // A dense ball and a sparse one beside it, of equal size: spread samples cover both equally.
  std::vector<DatasetPoint> points = ball(79, 3000, {0, 0, 0}, 1);
  for (const DatasetPoint& point : ball(80, 300, {4, 0, 0}, 1)) points.push_back(point);
  Random random(81);
  const Seeds seeds = seeds_at_points(points, {.count = 300, .radius = 0.25}, random);
  ASSERT_THAT(seeds.centers, SizeIs(300));
  const auto in_thin = [](std::span<const glm::dvec3> centers) {
    return double(std::ranges::count_if(centers, [](glm::dvec3 p) { return p.x > 2; })) /
           double(centers.size());
  };
  EXPECT_GT(in_thin(std::span(seeds.centers).first(200)), 0.3);
  EXPECT_LT(in_thin(std::span(seeds.centers).last(100)), 0.2);  // 1 in 11 of all points
  const std::vector<double> distances = nearest_distances(seeds.centers);
  double mean = 0;
  for (const double distance : distances) mean += distance / 300;
  const double rounding = 1e-13;  // of the mean, which is summed in another order here
  EXPECT_GT(*std::ranges::min_element(distances), 0);  // no duplicates
  for (const double radius : seeds.radii) EXPECT_NEAR(radius, 0.25 * mean, rounding);

  const Seeds local =
      seeds_at_points(points, {.count = 300, .radius = 0.25, .local = true}, random);
  const std::vector<double> local_distances = nearest_distances(local.centers);
  double local_mean = 0;
  for (const double distance : local_distances) local_mean += distance / 300;
  for (std::size_t i = 0; i < 300; ++i)
    EXPECT_NEAR(local.radii[i], 0.25 * std::max(local_distances[i], 0.1 * local_mean), rounding);
}

TEST(SeedsAtPoints, OfTooFewPointsLieBesideThem) {
  const std::vector<DatasetPoint> points = ball(82, 50, {7, 0, 0}, 1);
  Random random(83);
  const Seeds seeds = seeds_at_points(points, {.count = 400, .radius = 0.25}, random);
  ASSERT_THAT(seeds.centers, SizeIs(400));
  std::vector<glm::dvec3> positions;
  for (std::size_t i = 0; i < 50; ++i) {
    positions.push_back(points[i].position);
    EXPECT_EQ(seeds.centers[i], points[i].position);
  }
  const std::vector<double> reach = nearest_distances(positions);
  for (const glm::dvec3 center : seeds.centers) {
    bool beside = false;
    for (std::size_t i = 0; i < 50; ++i)
      beside |= glm::distance(center, positions[i]) <= reach[i] * (1 + 1e-12);
    EXPECT_TRUE(beside);
  }
}

TEST(SeedsAtPoints, SkipMistakesButNotWhatIsFar) {
  std::vector<DatasetPoint> points = ball(84, 960, {0, 0, 0}, 1);
  for (const DatasetPoint& point : ball(85, 40, {50, 0, 0}, 5)) points.push_back(point);
  points.push_back({.position = {0, 1e6, 0}, .color = {}});
  Random random(86);
  const Seeds seeds = seeds_at_points(points, {.count = 100, .radius = 0.25}, random);
  EXPECT_TRUE(std::ranges::none_of(seeds.centers, [](glm::dvec3 p) { return p.y > 100; }));
  EXPECT_TRUE(std::ranges::any_of(seeds.centers, [](glm::dvec3 p) { return p.x > 45; }));
}

TEST(SeedsAtPoints, ThatCoincideAreTakenOnce) {
  std::vector<DatasetPoint> points = ball(97, 40, {0, 0, 0}, 1);
  for (int i = 0; i < 40; ++i)
    for (int twin = 0; twin < 5; ++twin) points.push_back(points[std::size_t(i)]);
  for (const bool local : {false, true})
    for (const std::size_t count : {30u, 100u}) {
      Random random(98);
      const Seeds seeds =
          seeds_at_points(points, {.count = count, .radius = 0.25, .local = local}, random);
      ASSERT_THAT(seeds.centers, SizeIs(count));
      const std::vector<double> distances = nearest_distances(seeds.centers);
      EXPECT_GT(*std::ranges::min_element(distances), 0) << count;
      EXPECT_GT(*std::ranges::min_element(seeds.radii), 0) << count;
    }
}

TEST(SeedsAtPoints, OfOnePointLieAboutIt) {
  const std::vector<DatasetPoint> points(7, {.position = {3, 2, 1}, .color = {}});
  for (const std::size_t count : {1u, 50u}) {
    Random random(99);
    const Seeds seeds =
        seeds_at_points(points, {.count = count, .radius = 0.25, .lone_spacing = 2}, random);
    ASSERT_THAT(seeds.centers, SizeIs(count));
    EXPECT_EQ(seeds.centers[0], glm::dvec3(3, 2, 1));
    for (const glm::dvec3 center : seeds.centers)
      EXPECT_LE(glm::distance(center, seeds.centers[0]), 2);
    EXPECT_GT(*std::ranges::min_element(seeds.radii), 0);
    if (count == 1) {
      EXPECT_EQ(seeds.radii[0], 0.5);
    }
  }
}

TEST(RandomSeeds, FillTheCube) {
  const Dataset dataset = ring(87, {1, 2, 3}, 20.0);
  const Region region{{1, 2, 3}, 1.5};
  Random random(88);
  const Seeds seeds = random_seeds(region, dataset.train, {.count = 4000, .radius = 0.25}, random);
  glm::dvec3 mean(0.0), squares(0.0);
  for (const glm::dvec3 center : seeds.centers) {
    const glm::dvec3 p = (center - region.center) / 1.5;
    for (int axis = 0; axis < 3; ++axis) ASSERT_LE(std::abs(p[axis]), 1);
    mean += p / 4000.0;
    squares += p * p / 4000.0;
  }
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(mean[axis], 0, 5 * std::sqrt(1 / 3.0 / 4000));  // five standard errors
    EXPECT_NEAR(squares[axis], 1 / 3.0, 5 * std::sqrt(4 / 45.0 / 4000));
  }
  // Chandrasekhar: 0.554 / cbrt(density), plus a few percent for the borders of the cube.
  const double spacing = 0.554 * 3.0 / std::cbrt(4000.0);
  for (const double radius : seeds.radii) EXPECT_NEAR(radius, 0.25 * spacing, 0.1 * 0.25 * spacing);
}

TEST(RandomSeeds, LieAroundTheCubeWhereAsked) {
  const Dataset dataset = ring(89, {0, 0, 0}, 2.0);
  const Region region{{0, 0, 0}, 0.5};
  Random random(90);
  const Seeds seeds = random_seeds(
      region, dataset.train, {.count = 3000, .radius = 0.25, .far = 0.4, .far_extent = 8}, random);
  ASSERT_THAT(seeds.centers, SizeIs(3000));
  int beyond_two = 0;
  for (std::size_t i = 0; i < 3000; ++i) {
    const glm::dvec3 size = glm::abs(seeds.centers[i]) / 0.5;
    const double largest = std::max({size.x, size.y, size.z});
    const bool is_near = i < 1800;
    ASSERT_EQ(largest < 1, is_near) << i;
    ASSERT_LE(glm::length(size), 8 * (1 + 1e-12));
    beyond_two += glm::length(size) > 2;
    const double growth = is_near ? 1 : glm::length(size);
    ASSERT_NEAR(seeds.radii[i], seeds.radii[0] * growth, 1e-12);
  }
  // The logarithm of the distance is uniform from about 1.3 to 8; 2 to 8 are 3/4 of it.
  EXPECT_NEAR(beyond_two, 0.75 * 1200, 0.1 * 1200);
}

TEST(RandomSeeds, AreInSomeImage) {
  Dataset dataset;  // two cameras side by side see only a part of the cube
  dataset.train = {view_from({0, -1, 0}, {0, 5, 0}), view_from({0.1, -1, 0}, {0, 5, 0})};
  Random random(91);
  const Seeds seeds =
      random_seeds({{0, 0, 0}, 1.0}, dataset.train, {.count = 500, .radius = 0.25}, random);
  for (const glm::dvec3 center : seeds.centers) {
    bool seen = false;
    for (const Photograph& view : dataset.train) {
      const Camera& camera = view.camera;
      const glm::dvec4 clip =
          clip_from_view(camera, 0.01, 100) * camera.view_from_world * glm::dvec4(center, 1);
      seen |= clip.w > 0 && std::abs(clip.x) <= clip.w * (1 + 1e-9) &&
              std::abs(clip.y) <= clip.w * (1 + 1e-9);
    }
    EXPECT_TRUE(seen);
  }
}

// --- The model

TEST(InitialModel, IsTheSameForASeed) {
  Dataset dataset = ring(92, {1, 2, 3}, 4.0);
  dataset.points = ball(93, 500, {1, 2, 3}, 1);
  for (const Initialisation kind : {Initialisation::random, Initialisation::points}) {
    Config config = preset(Preset::object);
    config.initialisation = kind;
    config.initial_triangles = 200;
    config.seed = 1;
    const Model a = initial_model(dataset, config), b = initial_model(dataset, config);
    EXPECT_EQ(a.positions, b.positions);
    EXPECT_EQ(a.mlp, b.mlp);
    EXPECT_EQ(a.faces(), 200u);
    EXPECT_EQ(a.min_level, config.coarse_level);
    EXPECT_EQ(a.max_level, config.coarse_level);
    EXPECT_THAT(a.logits, Each(0.0f));
    EXPECT_THAT(a.logits, SizeIs(200 * 3 * channels));
    EXPECT_LT(glm::distance(a.origin, {1, 2, 3}), 0.02);
    config.seed = 2;
    const Model other = initial_model(dataset, config);
    EXPECT_NE(a.positions, other.positions);
    EXPECT_NE(a.mlp, other.mlp);
  }
}

TEST(InitialModel, BeginsAtPointsWhereThereAreSome) {
  Config config = preset(Preset::scene);
  config.initial_triangles = 100;
  config.backing_triangles = 0;
  Dataset dataset = ring(94, {0, 0, 0}, 4.0);
  const auto farthest = [](const Model& model) {
    float largest = 0;
    for (const glm::vec3 position : model.positions)
      largest = std::max(largest, glm::length(position));
    return largest;
  };
  EXPECT_GT(farthest(initial_model(dataset, config)), 2);  // half of them around the box
  dataset.points = ball(95, 500, {0, 0, 0}, 0.5);
  config.around_points = 0;
  EXPECT_LT(farthest(initial_model(dataset, config)), 1);
  config.around_points = 0.3f;
  const Model around = initial_model(dataset, config);
  EXPECT_EQ(around.faces(), 100u);
  EXPECT_GT(farthest(around), 2);
  int far = 0;  // the box's half side is 1.2: 4 tan(20 degrees) times 80 / 100
  for (std::size_t face = 0; face < 100; ++face)
    far += glm::length(around.positions[3 * face]) > 1.1f;
  EXPECT_EQ(far, 30);
  config.initialisation = Initialisation::random;
  EXPECT_GT(farthest(initial_model(dataset, config)), 2);
  config.initialisation = Initialisation::points;
  dataset.points.clear();
  EXPECT_THROW(initial_model(dataset, config), InputError);
}

TEST(InitialModel, OfAMeshBisectsToTheNumberOfTriangles) {
  const Scene mesh = scene_of(tureen::test::random_soup(
      96, {.kind = tureen::test::Kind::vertex_colors, .faces = 60, .shared_vertices = true}));
  Config config = preset(Preset::object);
  config.initialisation = Initialisation::mesh;
  config.initial_triangles = 100;
  const Dataset dataset = ring(97, {0, 0, 0}, 4.0);
  const Model model = initial_model(dataset, config, &mesh);
  EXPECT_EQ(model.faces(), 100u);
  EXPECT_EQ(model.logits.size(), 100 * 3u * channels);
  config.initial_triangles = 10;
  EXPECT_EQ(initial_model(dataset, config, &mesh).faces(), 60u);
}

// --- Gaussians

/// Thin Gaussians on the plane z = 2 and, where x < 0, on the plane y = 2, all with the same
/// opacity, in a layer at `origin`.
Scene gaussians_on_two_planes(std::size_t count, float opacity, glm::dvec3 origin) {
  Random random(98);
  Gaussians gaussians;
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec3 point = random.in_ball();
    gaussians.scales.emplace_back(0.2f, 0.001f, 0.1f);
    if (point.x < 0) {
      gaussians.centers.emplace_back(point.x, 2, point.y);
      gaussians.rotations.emplace_back(1, 0, 0, 0);
    } else {
      gaussians.centers.emplace_back(point.x, point.y, 2);
      // A quarter turn around x: the short axis, y, becomes z.
      gaussians.rotations.push_back(glm::angleAxis(glm::half_pi<float>(), glm::vec3(1, 0, 0)));
    }
    gaussians.opacity.push_back(opacity);
  }
  const std::vector<glm::vec3> colors(count, glm::vec3(0.5f));
  return scene_of(Splats{.kernel = std::move(gaussians), .color = {.coefficients = colors}},
                  origin);
}

TEST(NearestPoints, AreThoseOfASearchThroughAll) {
  Random random(101);
  std::vector<glm::dvec3> points, places;
  for (int i = 0; i < 200; ++i) points.push_back(random.in_ball());
  for (int i = 0; i < 50; ++i) places.push_back(2.0 * random.in_ball());
  const std::vector<std::uint32_t> nearest = nearest_points(points, places);
  ASSERT_EQ(nearest.size(), places.size());
  for (std::size_t i = 0; i < places.size(); ++i)
    for (const glm::dvec3& point : points)
      EXPECT_LE(glm::distance(points[nearest[i]], places[i]), glm::distance(point, places[i]));
}

TEST(InitialModel, BeginsOnGaussiansInTheirPlanes) {
  const glm::dvec3 center(100, -50, 20);
  const Dataset dataset = ring(99, center, 4.0);
  Config config = preset(Preset::object);
  for (const float opacity : {0.9f, 0.1f})  // if none is opaque, all count
    for (const int triangles : {100, 1000}) {
      config.initial_triangles = triangles;
      const Scene scene = gaussians_on_two_planes(300, opacity, center);
      const Model model = initial_model(dataset, config, &scene);
      ASSERT_EQ(model.faces(), std::size_t(triangles));
      int on_the_planes = 0;
      for (std::size_t face = 0; face < model.faces(); ++face) {
        const glm::dvec3 a = model.positions[3 * face], b = model.positions[3 * face + 1],
                         c = model.positions[3 * face + 2];
        const glm::dvec3 normal = glm::normalize(glm::cross(b - a, c - a));
        const glm::dvec3 middle = model.origin + (a + b + c) / 3.0 - center;
        // Corners near 2 are rounded by 1e-7, and triangles are at least 0.003 wide: a tenth of the
        // mean distance between 300 points on two half discs.
        EXPECT_NEAR(std::abs(middle.y > middle.z ? normal.y : normal.z), 1, 1e-4);
        on_the_planes += std::abs(std::max(middle.y, middle.z) - 2) < 1e-5;
      }
      // Further seeds lie in balls around the centres.
      EXPECT_GE(on_the_planes, std::min(triangles, 300));
    }
}

TEST(InitialModel, SkipsTransparentGaussians) {
  const Dataset dataset = ring(102, {0, 0, 0}, 4.0);
  Config config = preset(Preset::object);
  config.initial_triangles = 100;
  Scene scene = gaussians_on_two_planes(300, 0.9f, glm::dvec3(0));
  auto& gaussians = std::get<Gaussians>(std::get<Splats>(scene.layers[0].primitives).kernel);
  for (std::size_t i = 0; i < 300; ++i)
    if (gaussians.centers[i].x < 0) gaussians.opacity[i] = 0.1f;
  const Model model = initial_model(dataset, config, &scene);
  for (std::size_t face = 0; face < model.faces(); ++face) {
    const glm::vec3 sum =
        model.positions[3 * face] + model.positions[3 * face + 1] + model.positions[3 * face + 2];
    EXPECT_GE(sum.x / 3 + model.origin.x, 0) << face;
  }
}

TEST(InitialModel, BeginsAtRandomIfNoGaussianIsLeft) {
  const Dataset dataset = ring(100, {0, 0, 0}, 4.0);
  Config config = preset(Preset::object);
  config.initial_triangles = 50;
  const Scene scene = gaussians_on_two_planes(0, 1, glm::dvec3(0));
  EXPECT_EQ(initial_model(dataset, config, &scene).positions,
            initial_model(dataset, config).positions);
}

}  // namespace initialise_test
}  // namespace tureen::trainer
