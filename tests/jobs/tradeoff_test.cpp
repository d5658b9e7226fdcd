// Error against time: Pareto fronts, the choice, and the measured configurations.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <initializer_list>
#include <set>
#include <tuple>

#include "jobs/tradeoff/panel.hpp"
#include "jobs/tradeoff/pareto.hpp"
#include "jobs/tradeoff/references.hpp"
#include "jobs/tradeoff/settings.hpp"
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

/// Settings with these numbers of values, which change nothing.
std::vector<QualitySetting> settings_with(std::initializer_list<int> counts) {
  std::vector<QualitySetting> settings;
  for (const int count : counts)
    settings.push_back({"key", "title", std::vector<SettingValue>(std::size_t(count))});
  return settings;
}

TEST(SingleChanges, ChangeOneSettingAtATime) {
  EXPECT_THAT(single_changes(settings_with({3, 1, 2})),
              ElementsAre(Configuration{0, 0, 0}, Configuration{1, 0, 0}, Configuration{2, 0, 0},
                          Configuration{0, 0, 1}));
}

TEST(AConfiguration, AppliesTheChangesOfItsValues) {
  const std::vector<QualitySetting> settings{
      {"a", "a", {{}, {.change = {.edits = {.keeps_face = {1, 0}, .lattice_level = 2}}}}},
      {"b", "b", {{}, {.change = {.edits = {.color = Edits::Color::base, .byte_texels = true}}}}},
      {"c", "c", {{}, {.change = {.splat_edits = {.keeps_splat = {0}, .opaque_windows = true}}}}},
      {"d",
       "d",
       {{},
        {.change = {.quality = {.resolution_scale = 0.5,
                                .supersampling = 3,
                                .splat_order = Quality::SplatOrder::exact}}}}}};
  for (std::size_t i = 0; i < settings.size(); ++i) {
    Configuration configuration(4, 0);
    configuration[i] = 1;
    const Applied applied = applied_by(settings, configuration),
                  &change = settings[i].values[1].change;
    EXPECT_EQ(applied.edits, change.edits) << i;
    EXPECT_EQ(applied.splat_edits, change.splat_edits) << i;
    EXPECT_EQ(applied.quality, change.quality) << i;
  }
  const Applied all = applied_by(settings, {1, 1, 1, 1});
  EXPECT_EQ(all.edits.lattice_level, 2);
  EXPECT_EQ(all.edits.color, Edits::Color::base);
  EXPECT_TRUE(all.splat_edits.opaque_windows);
  EXPECT_EQ(all.quality.supersampling, 3);
}

Panel measured(const std::vector<QualitySetting>& settings,
               std::initializer_list<std::tuple<Configuration, double, double>> outcomes) {
  Panel panel;
  panel.settings = settings;
  for (const auto& [configuration, ms, psnr_db] : outcomes) {
    Outcome& outcome = panel.outcomes.emplace_back();
    outcome.configuration = configuration;
    outcome.ms.min_of_medians = ms;
    outcome.error.psnr_db = psnr_db;
  }
  return panel;
}

TEST(SettingRanges, CompareEachSettingWithTheDefaults) {
  Panel panel = measured(settings_with({3, 2}), {{{0, 0}, 10, 60},
                                                 {{1, 0}, 8, 55},
                                                 {{2, 0}, 12, 58},
                                                 {{0, 1}, 10, 45},
                                                 {{2, 1}, 1, 1},  // a combination
                                                 {{1, 0}, 100, 1}});
  panel.outcomes.back().factor = Factor::generic;
  find_ranges(panel);
  ASSERT_THAT(panel.ranges, SizeIs(2));
  EXPECT_EQ(panel.ranges[1].setting, 1u);
  EXPECT_DOUBLE_EQ(panel.ranges[0].time_ratio, 1.5);
  EXPECT_DOUBLE_EQ(panel.ranges[0].psnr_db, 5);
  EXPECT_TRUE(panel.ranges[0].matters());
  // A setting that takes no time does not matter, whatever its error.
  EXPECT_DOUBLE_EQ(panel.ranges[1].time_ratio, 1);
  EXPECT_DOUBLE_EQ(panel.ranges[1].psnr_db, 15);
  EXPECT_FALSE(panel.ranges[1].matters());
}

TEST(SettingRanges, PassOverErrorsThatMeanNothing) {
  Panel panel = measured(settings_with({3}), {{{0}, 10, 36}, {{1}, 20, 45}, {{2}, 40, 99}});
  panel.outcomes.back().applied.quality.supersampling = antialiased_samples;
  find_ranges(panel);
  EXPECT_DOUBLE_EQ(panel.ranges[0].psnr_db, 9);
  EXPECT_DOUBLE_EQ(panel.ranges[0].time_ratio, 4);
}

Panel with_ranges(std::initializer_list<int> counts, std::vector<SettingRange> ranges) {
  Panel panel;
  panel.settings = settings_with(counts);
  panel.ranges = std::move(ranges);
  return panel;
}

TEST(Combinations, AreOfTheSettingsThatMatter) {
  Panel panel = with_ranges({3, 2, 2}, {{0, 1.5, 5}, {1, 1.02, 9}, {2, 1.2, 3}});
  EXPECT_THAT(combinations_of(panel, 64),
              testing::UnorderedElementsAre(Configuration{1, 0, 1}, Configuration{2, 0, 1}));
  EXPECT_THAT(panel.notes, IsEmpty());
}

TEST(Combinations, WithTheSingleChangesAreAllOnce) {
  Panel panel = with_ranges({3, 4, 2, 3}, {{0, 2, 2}, {1, 2, 2}, {2, 2, 2}, {3, 2, 2}});
  const std::vector<Configuration> first = single_changes(panel.settings);
  std::set<Configuration> all(first.begin(), first.end());
  for (const Configuration& c : combinations_of(panel, 1000)) EXPECT_TRUE(all.insert(c).second);
  EXPECT_EQ(all.size(), 3u * 4 * 2 * 3);
}

TEST(Combinations, ReportWhatTheirLimitsOmit) {
  std::vector<SettingRange> ranges;
  for (std::size_t setting = 0; setting < 5; ++setting)
    ranges.push_back({setting, 1.1 + 0.1 * double(setting), 2});
  Panel panel = with_ranges({3, 3, 3, 3, 3}, ranges);
  // Four settings with three values have 81 combinations; 9 are single changes.
  EXPECT_THAT(combinations_of(panel, 72), SizeIs(72));
  EXPECT_THAT(panel.notes, ElementsAre(Names(5, 4, 72)));
  // The three settings with the largest effect remain: 27 combinations minus 7.
  const std::vector<Configuration> fewer = combinations_of(panel, 71);
  EXPECT_THAT(fewer, SizeIs(20));
  for (const Configuration& c : fewer) EXPECT_EQ(c[0] + c[1], 0);
  EXPECT_THAT(panel.notes, ElementsAre(testing::_, Names(5, 3, 71)));
  EXPECT_THAT(combinations_of(panel, 0), IsEmpty());
}

TEST(Combinations, OmitWhatCannotBeDrawn) {
  const std::vector<QualitySetting> settings = antialiasing_settings(4, true);
  const std::vector<std::size_t> all{0, 1, 2};
  // Scale and samples exclude each other: (2 + 2) * 2 combinations with the order remain.
  const std::vector<Configuration> drawn = combinations(settings, all);
  EXPECT_THAT(drawn, SizeIs(8));
  for (const Configuration& c : drawn) EXPECT_TRUE(c[0] == 0 || c[1] == 0);
}

}  // namespace tradeoff_test
}  // namespace tureen::tradeoff
