// Error against time: Pareto fronts, their area, the choice, and the measured configurations.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "jobs/tradeoff/experiment.hpp"
#include "jobs/tradeoff/pareto.hpp"
#include "jobs/tradeoff/quality_settings.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/random.hpp"

namespace tureen::tradeoff {
namespace tradeoff_test {

using test::Names;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

std::vector<Point> random_points(test::Random& random, int count, bool with_ties) {
  std::vector<Point> points;
  for (int i = 0; i < count; ++i) {
    Point point{.ms = random.uniform(1, 200), .psnr_db = random.uniform(15, 70)};
    // A coarse grid makes equal times and equal decibels common.
    if (with_ties) {
      point.ms = 1 + random.below(8);
      point.psnr_db = 30 + random.below(6);
      point.spread_ms = random.chance(0.5) ? 0 : random.uniform(0, 1.5);
      point.departures = int(random.below(4));
    }
    points.push_back(point);
  }
  return points;
}

TEST(ParetoFront, KeepsWhatNothingBeats) {
  const std::vector<Point> points{{.ms = 4, .psnr_db = 60},
                                  {.ms = 2, .psnr_db = 50},
                                  {.ms = 3, .psnr_db = 45},  // slower and worse than the second
                                  {.ms = 1, .psnr_db = 30},
                                  {.ms = 9, .psnr_db = 59}};  // slower and worse than the first
  EXPECT_THAT(pareto_front(points), ElementsAre(3, 1, 0));
  EXPECT_THAT(pareto_front(std::vector<Point>{}), IsEmpty());
}

TEST(ParetoFront, OfEqualsTakesTheSimpler) {
  // Times within either point's spread are equal, and so are errors within 0.1 dB.
  EXPECT_THAT(pareto_front(std::vector<Point>{
                  {.ms = 1.00, .spread_ms = 0.1, .psnr_db = 50.05, .departures = 2},
                  {.ms = 1.08, .spread_ms = 0.0, .psnr_db = 50.00, .departures = 1}}),
              ElementsAre(1));
  // If the difference is larger, complexity does not matter.
  EXPECT_THAT(pareto_front(std::vector<Point>{
                  {.ms = 1.00, .spread_ms = 0.1, .psnr_db = 50.2, .departures = 2},
                  {.ms = 1.08, .psnr_db = 50.0, .departures = 1}}),
              ElementsAre(0));
  // A tenth of a decibel does not justify a slower configuration.
  EXPECT_THAT(
      pareto_front(std::vector<Point>{{.ms = 1, .psnr_db = 50}, {.ms = 2, .psnr_db = 50.09}}),
      ElementsAre(0));
  // But several small steps do.
  EXPECT_THAT(
      pareto_front(std::vector<Point>{
          {.ms = 1, .psnr_db = 50}, {.ms = 2, .psnr_db = 50.09}, {.ms = 3, .psnr_db = 50.18}}),
      ElementsAre(0, 2));
}

TEST(ParetoFront, AChainOfTiesDoesNotDrift) {
  // Neighbours are tied, the first and the last are not. (Quarters are exact.)
  EXPECT_THAT(pareto_front(std::vector<Point>{{.ms = 1.00, .spread_ms = 0.25, .psnr_db = 50},
                                              {.ms = 1.25, .spread_ms = 0.25, .psnr_db = 51},
                                              {.ms = 1.50, .spread_ms = 0.25, .psnr_db = 52}}),
              ElementsAre(1, 2));
}

TEST(ParetoFront, IsTheNonDominatedSetOfRandomPoints) {
  const std::uint64_t seed = 20260601;
  SCOPED_TRACE("seed " + std::to_string(seed));
  test::Random random(seed);
  for (int round = 0; round < 200; ++round) {
    std::vector<Point> points = random_points(random, 1 + int(random.below(30)), false);
    std::set<std::size_t> expected;
    for (std::size_t i = 0; i < points.size(); ++i)
      if (std::none_of(points.begin(), points.end(), [&](const Point& other) {
            return other.ms <= points[i].ms && other.psnr_db >= points[i].psnr_db &&
                   (other.ms < points[i].ms || other.psnr_db > points[i].psnr_db);
          }))
        expected.insert(i);
    const std::vector<std::size_t> front = pareto_front(points, 0.0);
    ASSERT_EQ(std::set<std::size_t>(front.begin(), front.end()), expected) << "round " << round;
  }
}

TEST(ParetoFront, WithTiesItRisesAndCoversTheRest) {
  const std::uint64_t seed = 20260602;
  SCOPED_TRACE("seed " + std::to_string(seed));
  test::Random random(seed);
  for (int round = 0; round < 500; ++round) {
    const std::vector<Point> points = random_points(random, 1 + int(random.below(40)), true);
    const std::vector<std::size_t> front = pareto_front(points);
    for (std::size_t i = 1; i < front.size(); ++i) {
      ASSERT_GT(points[front[i]].ms, points[front[i - 1]].ms);
      ASSERT_GT(points[front[i]].psnr_db, points[front[i - 1]].psnr_db + psnr_tie_db);
    }
    for (const Point& point : points)
      ASSERT_TRUE(std::any_of(front.begin(), front.end(),
                              [&](std::size_t i) {
                                const Point& kept = points[i];
                                // Another point may be the fastest of its group; the largest spread
                                // bounds the difference.
                                return kept.ms <= point.ms + 1.5 &&
                                       kept.psnr_db >= point.psnr_db - psnr_tie_db;
                              }))
          << "round " << round;
  }
}

TEST(Hypervolume, OfOneAndTwoPoints) {
  // A tenth of the corner's time: one decade, times 30 dB.
  EXPECT_DOUBLE_EQ(hypervolume(std::vector<Point>{{.ms = 10, .psnr_db = 50}}), 30);
  EXPECT_DOUBLE_EQ(
      hypervolume(std::vector<Point>{{.ms = 10, .psnr_db = 50}, {.ms = 1, .psnr_db = 30}}),
      1 * 30 + 1 * 10);
  // Points beyond the corner add nothing.
  EXPECT_EQ(hypervolume(std::vector<Point>{{.ms = 100, .psnr_db = 50}, {.ms = 1, .psnr_db = 20}}),
            0);
  EXPECT_EQ(hypervolume(std::vector<Point>{}), 0);
}

TEST(Hypervolume, IsTheAreaThatDartsFind) {
  const std::uint64_t seed = 20260603;
  SCOPED_TRACE("seed " + std::to_string(seed));
  test::Random random(seed);
  for (int round = 0; round < 10; ++round) {
    const std::vector<Point> points = random_points(random, 12, false);
    // Random samples over three decades and 80 dB, which contain the whole area.
    const int darts = 20000;
    int hits = 0;
    for (int dart = 0; dart < darts; ++dart) {
      const double ms = std::pow(10, random.uniform(-1, 2)), psnr = random.uniform(20, 100);
      hits += std::any_of(points.begin(), points.end(), [&](const Point& point) {
        return point.ms <= ms && point.psnr_db >= psnr;
      });
    }
    const double p = double(hits) / darts;
    // Five standard errors of the samples' mean, plus one sample for p = 0.
    const double allowed = 240 * (5 * std::sqrt(p * (1 - p) / darts) + 1.0 / darts);
    EXPECT_NEAR(hypervolume(points), 240 * p, allowed) << "round " << round;
  }
}

TEST(TheChoice, IsTheCheapestWithinTheLimits) {
  const std::vector<Point> points{{.ms = 9, .psnr_db = 90},
                                  {.ms = 1, .psnr_db = 49.9},
                                  {.ms = 2, .psnr_db = 60, .coverage_mismatch = 2e-4},
                                  {.ms = 3, .psnr_db = 50, .coverage_mismatch = 1e-4}};
  EXPECT_EQ(cheapest_within(points), 3u);
  EXPECT_EQ(cheapest_within(points, {.min_psnr_db = 70}), 0u);
  EXPECT_EQ(cheapest_within(points, {.min_psnr_db = 91}), std::nullopt);
  EXPECT_EQ(cheapest_within(points, {.min_psnr_db = 40}), 1u);
}

TEST(TheChoice, PrefersTheSimplerOfTheEquallyFast) {
  const std::vector<Point> points{{.ms = 1.0, .spread_ms = 0.1, .psnr_db = 55, .departures = 2},
                                  {.ms = 1.05, .psnr_db = 52, .departures = 1},
                                  {.ms = 1.06, .psnr_db = 53, .departures = 1},
                                  {.ms = 1.2, .psnr_db = 60, .departures = 0}};
  EXPECT_EQ(cheapest_within(points), 2u);
}

std::optional<std::string> nothing_refused(const Configuration&) { return {}; }

TEST(Star, ChangesOneSettingAtATime) {
  const std::vector<int> value_counts{3, 1, 2};
  const Design design = star(value_counts, nothing_refused);
  EXPECT_THAT(design.configurations, ElementsAre(Configuration{0, 0, 0}, Configuration{1, 0, 0},
                                                 Configuration{2, 0, 0}, Configuration{0, 0, 1}));
  EXPECT_THAT(design.skipped, IsEmpty());
}

TEST(Star, SaysWhyAConfigurationIsSkipped) {
  const std::vector<int> value_counts{3, 2};
  const Design design =
      star(value_counts, [](const Configuration& c) -> std::optional<std::string> {
        if (c[0] == 2) return "the device has no such thing";
        return {};
      });
  EXPECT_THAT(design.configurations, SizeIs(3));
  ASSERT_THAT(design.skipped, SizeIs(1));
  EXPECT_EQ(design.skipped[0].configuration, (Configuration{2, 0}));
  EXPECT_EQ(design.skipped[0].reason, "the device has no such thing");
}

TEST(SettingRanges, CompareEachSettingWithTheDefaults) {
  const std::vector<Configuration> star{{0, 0}, {1, 0}, {2, 0}, {0, 1}};
  const double none = std::nan("");
  const std::vector<Measured> measured{{10, 60}, {8, 55}, {12, 58}, {none, 45}};
  const std::vector<SettingRange> ranges = setting_ranges(star, measured, 2);
  EXPECT_DOUBLE_EQ(ranges[0].time_ratio, 1.5);
  EXPECT_DOUBLE_EQ(ranges[0].psnr_db, 5);
  EXPECT_TRUE(ranges[0].matters());
  // A setting without a time does not matter, whatever its error.
  EXPECT_DOUBLE_EQ(ranges[1].time_ratio, 1);
  EXPECT_DOUBLE_EQ(ranges[1].psnr_db, 15);
  EXPECT_FALSE(ranges[1].matters());
}

TEST(SettingRanges, PassOverErrorsThatMeanNothing) {
  const std::vector<Configuration> star{{0}, {1}, {2}};
  const std::vector<Measured> measured{{10, 36}, {20, 45}, {40, std::nan("")}};
  const SettingRange range = setting_ranges(star, measured, 1).front();
  EXPECT_DOUBLE_EQ(range.psnr_db, 9);
  EXPECT_DOUBLE_EQ(range.time_ratio, 4);
}

TEST(Factorial, CombinesTheSettingsThatMatter) {
  const std::vector<int> value_counts{3, 2, 2};
  const std::vector<SettingRange> ranges{{0, 1.5, 5}, {1, 1.02, 9}, {2, 1.2, 3}};
  const Design design = factorial(value_counts, ranges, nothing_refused);
  EXPECT_THAT(design.configurations, ElementsAre(Configuration{1, 0, 1}, Configuration{2, 0, 1}));
  EXPECT_EQ(design.reduction.mattering, 2u);
  EXPECT_EQ(design.reduction.combined, 2u);
  EXPECT_THAT(describe(design.reduction, {}), IsEmpty());
}

TEST(Factorial, WithTheStarIsEveryCombinationOnce) {
  const std::vector<int> value_counts{3, 4, 2, 3};
  std::vector<SettingRange> ranges;
  for (std::size_t setting = 0; setting < value_counts.size(); ++setting)
    ranges.push_back({setting, 2, 2});
  const Design first = star(value_counts, nothing_refused);
  const Design rest =
      factorial(value_counts, ranges, nothing_refused, {.max_configurations = 1000});
  std::set<Configuration> all(first.configurations.begin(), first.configurations.end());
  for (const Configuration& c : rest.configurations) EXPECT_TRUE(all.insert(c).second);
  EXPECT_EQ(all.size(), 3u * 4 * 2 * 3);
}

TEST(Factorial, ReportsWhatItsLimitsOmit) {
  const std::vector<int> value_counts{3, 3, 3, 3, 3};
  std::vector<SettingRange> ranges;
  for (std::size_t setting = 0; setting < 5; ++setting)
    ranges.push_back({setting, 1.1 + 0.1 * double(setting), 2});
  // Four settings with three values have 81 combinations; the star contains 9.
  const FactorialLimits limits{.max_configurations = 71};
  const Design design = factorial(value_counts, ranges, nothing_refused, limits);
  EXPECT_EQ(design.reduction.mattering, 5u);
  EXPECT_EQ(design.reduction.wanted, 4u);
  EXPECT_EQ(design.reduction.configurations, 72u);
  EXPECT_EQ(design.reduction.combined, 3u);
  EXPECT_THAT(describe(design.reduction, limits), ElementsAre(Names(5, 4), Names(4, 72, 71, 3)));
  // The three settings with the largest effect remain: 27 combinations minus 7.
  EXPECT_THAT(design.configurations, SizeIs(20));
  for (const Configuration& c : design.configurations) EXPECT_EQ(c[0] + c[1], 0);
  EXPECT_THAT(
      factorial(value_counts, ranges, nothing_refused, {.max_configurations = 72}).configurations,
      SizeIs(72));
  EXPECT_THAT(
      factorial(value_counts, ranges, nothing_refused, {.max_configurations = 0}).configurations,
      IsEmpty());
}

TEST(Factorial, SkipsWhatCannotBeDrawn) {
  const std::vector<int> value_counts{2, 2};
  const std::vector<SettingRange> ranges{{0, 2, 2}, {1, 2, 2}};
  const Design design = factorial(value_counts, ranges, [](const Configuration&) {
    return std::optional<std::string>("not together");
  });
  EXPECT_THAT(design.configurations, IsEmpty());
  ASSERT_THAT(design.skipped, SizeIs(1));
  EXPECT_EQ(design.skipped[0].reason, "not together");
}

TEST(Factorial, SaysOnceWhatCannotBeDrawnTogetherAndDoesNotCountIt) {
  const std::vector<int> value_counts{2, 3, 2};
  const auto refuse = [](const Configuration& c) -> std::optional<std::string> {
    if (c[1] != 0 && c[2] != 0) return "fewer and more";
    return {};
  };
  // Of the 7 combinations, 4 change both exclusive settings.
  const std::vector<Configuration> drawn{{1, 0, 1}, {1, 1, 0}, {1, 2, 0}};
  for (const double last_ratio : {1.1, 1.9}) {  // the third setting is ranked last, then first
    const std::vector<SettingRange> ranges{{0, 1.5, 5}, {1, 1.4, 5}, {2, last_ratio, 5}};
    const Design design = factorial(value_counts, ranges, refuse, {.max_configurations = 3});
    EXPECT_THAT(design.configurations, testing::UnorderedElementsAreArray(drawn));
    EXPECT_EQ(design.reduction.combined, 3u);
    std::vector<Configuration> skipped;
    for (const Skipped& each : design.skipped) skipped.push_back(each.configuration);
    EXPECT_THAT(skipped,
                testing::UnorderedElementsAre(Configuration{0, 1, 1}, Configuration{0, 2, 1}));
  }
  const std::vector<SettingRange> ranges{{0, 1.5, 5}, {1, 1.4, 5}, {2, 1.3, 5}};
  const Design fewer = factorial(value_counts, ranges, refuse, {.max_configurations = 2});
  EXPECT_EQ(fewer.reduction.configurations, 3u);
  EXPECT_EQ(fewer.reduction.combined, 2u);
}

}  // namespace tradeoff_test
}  // namespace tureen::tradeoff
