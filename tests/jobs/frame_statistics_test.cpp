// Statistics of frame times, for series with known results.
#include "jobs/timing/frame_statistics.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

namespace tureen {
namespace frame_statistics_test {

TEST(FrameStatistics, MedianOfOddAndEvenCounts) {
  EXPECT_EQ(median(std::vector<double>{7}), 7);
  EXPECT_EQ(median(std::vector<double>{9, 1, 5}), 5);
  EXPECT_EQ(median(std::vector<double>{9, 1, 5, 7}), 6);
}

TEST(FrameStatistics, PercentilesAreNearestRanks) {
  std::vector<double> values(20);
  std::iota(values.rbegin(), values.rend(), 1);  // 20 .. 1
  EXPECT_EQ(percentile(values, 95), 19);
  EXPECT_EQ(percentile(values, 99), 20);
  EXPECT_EQ(percentile(values, 5), 1);
  EXPECT_EQ(percentile(values, 5.1), 2);
  EXPECT_EQ(percentile(values, 100), 20);
  EXPECT_EQ(percentile(std::vector<double>{3}, 50), 3);
}

TEST(FrameStatistics, OfTwoHundredFramesTheSlowestTwoMakeTheLowPercent) {
  FrameTimes times{.views = 100, .ms = std::vector<double>(200, 10.0)};
  times.ms[17] = 40;
  times.ms[150] = 60;
  const FrameStatistics statistics = statistics_of(times);
  EXPECT_DOUBLE_EQ(statistics.mean, (198 * 10.0 + 100) / 200);
  EXPECT_EQ(statistics.median, 10);
  EXPECT_EQ(statistics.p95, 10);
  EXPECT_EQ(statistics.p99, 10);
  EXPECT_DOUBLE_EQ(statistics.low_1_percent_fps, 1000.0 / 50);
}

TEST(FrameStatistics, FewFramesHaveOneSlowest) {
  const FrameStatistics statistics = statistics_of({.views = 2, .ms = {4, 5}});
  EXPECT_EQ(statistics.low_1_percent_fps, 200);
  EXPECT_EQ(statistics.p99, 5);
}

TEST(FrameStatistics, MinOfMediansIgnoresTheDisturbedRound) {
  // Medians 5, 6, 50, 5.5: of four, the third quartile is the third smallest, 6.
  const FrameTimes times{.views = 3, .ms = {5, 5, 9, 6, 1, 7, 50, 50, 50, 5.5, 5.5, 5.5}};
  const FrameStatistics statistics = statistics_of(times);
  EXPECT_EQ(statistics.min_of_medians, 5);
  EXPECT_DOUBLE_EQ(statistics.spread, (6.0 - 5.0) / 5.0);
}

TEST(FrameStatistics, AViewHasTheMedianOfItsRounds) {
  const FrameTimes times{.views = 2, .ms = {1, 10, 3, 30, 2, 20}};
  EXPECT_EQ(view_medians(times), (std::vector<double>{2, 20}));
}

TEST(FrameStatistics, ASeriesDoesNotDifferFromItself) {
  const FrameTimes times{.views = 2, .ms = {1, 10, 3, 30, 2, 20}};
  EXPECT_EQ(series_spread(times, times), 0);
}

TEST(FrameStatistics, ALuckyPairOfMinimaHidesNoSpread) {
  // Both series reach 10, but each round differs by 20 %.
  const FrameTimes first{.views = 1, .ms = {10, 12, 12}};
  const FrameTimes second{.views = 1, .ms = {12, 10, 10}};
  EXPECT_DOUBLE_EQ(series_spread(first, second), 0.2);
  // One equal pair of rounds must not hide the difference of the minima.
  const FrameTimes third{.views = 1, .ms = {15, 15, 10}};
  const FrameTimes fourth{.views = 1, .ms = {15, 15, 15}};
  EXPECT_DOUBLE_EQ(series_spread(third, fourth), 0.5);
}

FrameStatistics best(double ms, double spread = 0, int rounds = 5) {
  return {.min_of_medians = ms, .spread = spread, .rounds = rounds};
}

TEST(FrameStatistics, KnowHowManyRoundsAndSamplesTheyAreOf) {
  const FrameStatistics statistics = statistics_of({.views = 2, .ms = {1, 10, 3, 30, 2, 20}});
  EXPECT_EQ(statistics.rounds, 3);
  EXPECT_EQ(statistics.samples, 6u);
}

TEST(FrameStatistics, AHundredSamplesTellTheSlowestPercent) {
  std::vector<double> ms(99, 10.0);
  ms[50] = 60;
  const FrameStatistics few = statistics_of({.views = 1, .ms = ms});
  EXPECT_EQ(few.p99, 60) << "the slowest sample";
  EXPECT_FALSE(tells_slowest_percent(few));
  ms.push_back(10);
  const FrameStatistics enough = statistics_of({.views = 1, .ms = ms});
  EXPECT_EQ(enough.p99, 10);
  EXPECT_TRUE(tells_slowest_percent(enough));
}

TEST(Verdicts, TwiceTheSpreadIsADifference) {
  EXPECT_EQ(verdict_on(best(103), best(100), 0.02), Verdict::equal);
  EXPECT_EQ(verdict_on(best(105), best(100), 0.02), Verdict::slower);
  EXPECT_EQ(verdict_on(best(100), best(105), 0.02), Verdict::faster);
  EXPECT_EQ(verdict_on(best(100), best(100), 0), Verdict::equal) << "equal times without a spread";
}

TEST(Verdicts, TheLargestSpreadCounts) {
  EXPECT_EQ(spread_between(best(1, 0.03), best(1, 0.01), 0.02), 0.03);
  EXPECT_EQ(spread_between(best(1, 0.01), best(1, 0.03), 0.02), 0.03);
  EXPECT_EQ(spread_between(best(1, 0.01), best(1, 0.01), 0.02), 0.02);
  EXPECT_EQ(verdict_on(best(105, 0.03), best(100), 0.02), Verdict::equal);
  EXPECT_EQ(verdict_on(best(105), best(100, 0.03), 0.02), Verdict::equal);
}

TEST(Verdicts, FewRoundsHaveNoSpread) {
  for (const int rounds : {1, 2}) {
    EXPECT_EQ(spread_between(best(100, 0, rounds), best(900), 0), std::nullopt) << rounds;
    EXPECT_EQ(verdict_on(best(100), best(900, 0, rounds), 0), Verdict::unknown) << rounds;
  }
  EXPECT_EQ(verdict_on(best(100, 0, min_rounds), best(900, 0, min_rounds), 0), Verdict::faster);
}

}  // namespace frame_statistics_test
}  // namespace tureen
