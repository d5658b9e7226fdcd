// Tables of a benchmark in the terminal.
#include "cli/bench/bench_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli/measuring/bench_words.hpp"
#include "tests/support/errors.hpp"

namespace tureen::cli {
namespace bench_table_test {

using test::Names;
using testing::Contains;
using testing::EndsWith;
using testing::HasSubstr;
using testing::MatchesRegex;
using testing::Not;

BenchMeasurement measurement(const std::string& configuration, const std::string& size, double ms) {
  BenchMeasurement result;
  result.configuration = configuration;
  result.camera_set = "orbit:8";
  result.size = size;
  result.width = 640;
  result.height = 360;
  result.views = 8;
  result.frame_ms = {.mean = ms + 1,
                     .median = ms,
                     .p95 = ms + 2,
                     .p99 = ms + 3,
                     .min_of_medians = ms,
                     .spread = 0,
                     .low_1_percent_fps = 1000 / (ms + 3),
                     .rounds = 15,
                     .samples = 120};
  result.fps = 1000 / (ms + 1);
  result.aa_spread = 0.02;
  result.passes_gap = PassTimesGap::no_timers;
  result.passes_reason = "no timers here";
  return result;
}

BenchResult two_sizes() {
  BenchResult result;
  result.device = {.context = "EGL, OpenGL 4.5 core",
                   .renderer = "a card",
                   .vendor = "",
                   .version = "",
                   .software = false};
  result.scene.triangles = 15000;
  result.measurements = {measurement("tureen", "640x360", 10),
                         measurement("generic", "640x360", 10.3),
                         measurement("published", "640x360", 52), measurement("tureen", "full", 4),
                         measurement("published", "full", 2)};
  return result;
}

TEST(BenchTable, HoldsEachAgainstTheFirstOfItsSize) {
  const std::vector<std::string> lines = bench_table(two_sizes());
  EXPECT_THAT(lines, Contains(Names("640 x 360", "orbit:8", 8, 15, "2.0 %")).Times(2));
  EXPECT_THAT(lines, Contains(AllOf(HasSubstr("tureen "), EndsWith("  1.00"))).Times(2));
  EXPECT_THAT(lines, Contains(MatchesRegex(" *published +52.0 +53.0 +52.0 +54.0 +55.0 .*")))
      << "best, mean, p50, p95, p99";
  // 3 % is less than twice the spread of 2 %.
  EXPECT_THAT(lines, Contains(AllOf(HasSubstr("generic "), EndsWith("  equal"))));
  EXPECT_THAT(lines, Contains(AllOf(HasSubstr("published "), EndsWith("  5.20"))));
  EXPECT_THAT(lines, Contains(AllOf(HasSubstr("published "), EndsWith("  0.50"))));
}

TEST(BenchTable, HoldsRatiosAgainstTheSpreadOfTheRounds) {
  BenchResult result = two_sizes();
  result.measurements[2].frame_ms.spread = 2.2;  // 52 exceeds 10 by 4.2 times 10
  EXPECT_THAT(bench_table(result), Contains(AllOf(HasSubstr("published "), EndsWith("  equal"))));
  for (BenchMeasurement& each : result.measurements) each.frame_ms.rounds = 1;
  const std::vector<std::string> lines = bench_table(result);
  EXPECT_THAT(lines, Contains(AllOf(HasSubstr("published "), EndsWith(" 1 round"))).Times(2));
  EXPECT_THAT(lines, Not(Contains(EndsWith("equal"))));
}

TEST(BenchTable, OmitsAPercentileThatWouldBeTheSlowestSample) {
  BenchResult result = two_sizes();
  result.measurements[2].frame_ms.samples = 99;
  EXPECT_THAT(bench_table(result),
              Contains(MatchesRegex(" *published +52.0 +53.0 +52.0 +54.0 +– +18.9 +– +5.20")));
}

TEST(BenchTable, WarnsOfABuildThatIsNoRelease) {
  BenchResult result = two_sizes();
  const std::vector<std::string> unknown = bench_table(result);
  result.program.build = "release";
  EXPECT_EQ(bench_table(result), unknown);
  result.program.build = "debug";
  EXPECT_THAT(bench_table(result), Contains(Names("debug")));
}

TEST(BenchTable, SaysWhatMemoryIsOfWhen) {
  BenchResult result = two_sizes();
  result.load.peak_mib = 40;
  result.machine.rasteriser_threads = 2;
  EXPECT_THAT(bench_table(result), Contains(Names("40 MiB")));
  result.peak_mib = 70;
  EXPECT_THAT(bench_table(result), Contains(Names("40 MiB", "70 MiB")));
  EXPECT_THAT(bench_table(result), Contains(machine_text(result.machine)));
  EXPECT_THAT(machine_text(result.machine), Names(2));
}

TEST(BenchTable, SaysWhyPassesHaveNoTimesOnce) {
  BenchResult result = two_sizes();
  EXPECT_THAT(bench_table(result), Contains(HasSubstr("no timers here")).Times(1));
  result.measurements[1].passes_gap = PassTimesGap::exceeds_wall_clock;
  result.measurements[1].passes_reason = "4 ms of 3 ms";
  result.measurements[2].passes_gap = PassTimesGap::exceeds_wall_clock;
  result.measurements[2].passes_reason = "5 ms of 3 ms";
  result.measurements[3].passes_gap = PassTimesGap::one_pass;
  result.measurements[3].passes_reason = "a copy";
  const std::vector<std::string> lines = bench_table(result);
  EXPECT_THAT(lines, Contains(HasSubstr("no timers here")).Times(1));
  EXPECT_THAT(lines, Contains(HasSubstr("ms of 3 ms")).Times(1)) << "one line a kind";
  EXPECT_THAT(lines, Contains(HasSubstr("a copy")).Times(0));
}

TEST(BenchTable, ShowsThePassesThatTheDeviceTimed) {
  BenchResult result = two_sizes();
  for (BenchMeasurement& each : result.measurements) each.passes_gap = PassTimesGap::none;
  result.measurements[0].passes_ms = {{"visibility", 0.1234}, {"shading", 7.891}};
  const std::vector<std::string> lines = bench_table(result);
  EXPECT_THAT(lines, Contains(HasSubstr("visibility 0.123 ms, shading 7.89 ms")));
  result.measurements[0].passes_gap = PassTimesGap::partial;
  result.measurements[0].passes_reason = "one pass has no timer";
  EXPECT_THAT(bench_table(result), Contains(MatchesRegex(" +one pass has no timer")));
  EXPECT_EQ(bench_table(result).size(), lines.size() + 1) << "once, beside its row";
}

TEST(BenchTable, WarnsOfSoftwareAndOfRestlessness) {
  BenchResult result = two_sizes();
  const std::vector<std::string> before = bench_table(result);
  result.device.software = true;
  const std::vector<std::string> lines = bench_table(result);
  EXPECT_NE(lines.front(), before.front());
  result.measurements[1].stable = false;
  EXPECT_EQ(bench_table(result).size(), lines.size() + 1);
}

}  // namespace bench_table_test
}  // namespace tureen::cli
