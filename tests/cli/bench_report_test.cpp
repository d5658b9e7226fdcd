// Reports of a result of `tureen bench`: comparison and files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "base/error.hpp"
#include "base/output.hpp"
#include "cli/bench/bench_reports.hpp"
#include "cli/measuring/bench_words.hpp"
#include "jobs/bench/bench_json.hpp"
#include "jobs/bench/comparison_json.hpp"
#include "tests/formats/format_testing.hpp"
#include "tests/support/errors.hpp"

namespace tureen::cli {
namespace bench_report_test {

using test::Names;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::MatchesRegex;
using ::testing::Not;
using tureen::test::TemporaryFolder;

/// A name with characters that CSV, HTML, Markdown and shells interpret.
const std::string awkward = "a,\"b\" <i>`c` 'd'\\";

BenchMeasurement measurement(const std::string& configuration, const std::string& cameras,
                             int width, double ms) {
  return {.configuration = configuration,
          .camera_set = cameras,
          .size = std::to_string(width) + "x360",
          .width = width,
          .height = 360,
          .views = 3,
          .frames_per_sample = 1,
          .frames = 15,
          .frame_ms = {.mean = 1.02 * ms,
                       .median = 1.01 * ms,
                       .p95 = 1.2 * ms,
                       .p99 = 1.3 * ms,
                       .min_of_medians = ms,
                       .spread = 0.01,
                       .low_1_percent_fps = 1000 / (1.3 * ms),
                       .rounds = 5,
                       .samples = 15},
          .fps = 1000 / (1.02 * ms),
          .aa_spread = 0.02,
          .stable = true,
          .passes_ms = {},
          .passes_gap = PassTimesGap::no_timers,
          .passes_reason = "timers mislead <here>",
          .gpu_ms = {},
          .views_ms = {0.9 * ms, ms, 1.1 * ms},
          .pixels_hash = "0123456789abcdef",
          .image = {}};
}

BenchResult result() {
  BenchResult result;
  result.date = "2026-01-02T03:04:05Z";
  result.program = {"0.1.0", "abc1234", {"bench", "it's a scene.glb", "--sweep"}};
  result.scene = {awkward, awkward, 15000, "lattice"};
  result.machine = {"Some CPU & more", 2, 4096};
  result.device = {"EGL", "llvmpipe <256 bits>", "Mesa", "4.5 driver 9", true};
  result.protocol = {.clock = "steady", .rounds = 5, .aa_spread = 0.02};
  result.load = {1, 2, 3, 4, 5};
  result.configurations = {{"tureen", {}, {"M1: no <network>"}, 2, 3, 5},
                           {"published", {"--pipeline", "published"}, {}, 0, 6, 7}};
  for (const std::string& cameras : {std::string("hemisphere:3"), awkward})
    for (const int width : {640, 1280}) {
      result.measurements.push_back(measurement("tureen", cameras, width, width / 64.0));
      result.measurements.push_back(measurement("published", cameras, width, width / 16.0));
    }
  result.measurements[0].gpu_ms = 7.25;
  result.measurements[0].passes_ms = {{"visibility", 4}, {"shading", 3}};
  return result;
}

using What = BenchChange::What;

auto changed(What what, const std::string& then, const std::string& now) {
  return AllOf(Field(&BenchChange::what, what), Field(&BenchChange::then, then),
               Field(&BenchChange::now, now));
}

std::vector<What> whats(const BenchComparison& comparison) {
  std::vector<What> result;
  for (const BenchChange& change : comparison.changes) result.push_back(change.what);
  return result;
}

auto unmatched(UnmatchedBench::In in, const std::string& configuration) {
  return AllOf(
      Field(&UnmatchedBench::in, in),
      Field(&UnmatchedBench::measurement, Field(&BenchMeasurement::configuration, configuration)));
}

TEST(BenchComparison, SaysWhatDiffersByMoreThanTwiceTheSpread) {
  const BenchResult then = result();
  BenchResult now = then;
  // The spread is 2 %, the larger of the two kinds.
  now.measurements[0].frame_ms.min_of_medians *= 1.035;
  now.measurements[1].frame_ms.min_of_medians *= 1.045;
  now.measurements[2].frame_ms.min_of_medians /= 1.2;
  now.measurements[3].frame_ms.min_of_medians *= 1.2;
  now.measurements[3].frame_ms.spread = 0.3;
  now.measurements[4].pixels_hash = "fedcba9876543210";
  const BenchComparison comparison = compare_benches(now, then);
  ASSERT_EQ(comparison.ratios.size(), 8u);
  std::vector<std::string> verdicts;
  for (const BenchRatio& ratio : comparison.ratios)
    verdicts.push_back(verdict_text(ratio.verdict, ratio.rounds));
  EXPECT_THAT(verdicts, ElementsAre("equal", "slower", "faster", "equal", "equal", "equal", "equal",
                                    "equal"));
  EXPECT_NEAR(comparison.ratios[1].ratio, 1.045, 1e-12);
  EXPECT_EQ(comparison.ratios[3].spread, 0.3);
  EXPECT_TRUE(comparison.ratios[0].same_pixels);
  EXPECT_FALSE(comparison.ratios[4].same_pixels);
  EXPECT_THAT(comparison.changes, IsEmpty());
  EXPECT_THAT(comparison.unmatched, IsEmpty());
  EXPECT_EQ(slower_than(comparison, 4).size(), 1u);
  EXPECT_EQ(slower_than(comparison, 5).size(), 0u) << "20 % with a spread of 30 % proves nothing";
}

TEST(BenchComparison, ClaimsNothingOfFewRounds) {
  const BenchResult then = result();
  BenchResult now = then;
  for (BenchMeasurement& m : now.measurements) m.frame_ms.min_of_medians *= 9;
  now.measurements[0].frame_ms.rounds = 1;
  const BenchComparison comparison = compare_benches(now, then);
  EXPECT_EQ(comparison.ratios[0].verdict, Verdict::unknown);
  EXPECT_EQ(comparison.ratios[0].spread, std::nullopt);
  const std::vector<std::string> lines = comparison_lines(comparison);
  EXPECT_THAT(lines.at(1), MatchesRegex(".* 9.000  1 round +–")) << "below the headings";
  EXPECT_THAT(lines.at(2), MatchesRegex(".* 9.000  slower +2.0 %"));
  EXPECT_EQ(slower_than(comparison, 0).size(), now.measurements.size() - 1);
}

TEST(BenchComparison, SaysWhatBuildAndThreadsChanged) {
  BenchResult then = result();
  BenchResult now = then;
  now.program.build = "debug";
  now.machine.rasteriser_threads = 4;
  EXPECT_THAT(compare_benches(now, then).changes, IsEmpty()) << "an older file";
  then.program.build = "release";
  then.machine.rasteriser_threads = 2;
  const BenchComparison comparison = compare_benches(now, then);
  EXPECT_THAT(comparison.changes, ElementsAre(changed(What::rasteriser_threads, "2", "4"),
                                              changed(What::build, "release", "debug")));
}

TEST(BenchComparison, SaysWhatElseChanged) {
  const BenchResult then = result();
  BenchResult now = then;
  now.scene.triangles = 14000;
  now.machine.cores = 4;
  now.device.version = "another";
  now.program.commit = "def5678";
  const BenchComparison comparison = compare_benches(now, then);
  EXPECT_EQ(comparison.incomparable, std::nullopt);
  EXPECT_THAT(whats(comparison),
              ElementsAre(What::scene, What::machine, What::driver, What::commit));
  EXPECT_THAT(comparison.changes[3], changed(What::commit, "abc1234", "def5678"));
  const Json json = results::to_json(comparison, "old.json");
  EXPECT_EQ(json["changes"][3],
            (Json{{"what", "commit"}, {"then", "abc1234"}, {"now", "def5678"}}));
  EXPECT_TRUE(json["incomparable"].is_null());
}

TEST(BenchComparison, SoftwareAndHardwareAreNotCompared) {
  const BenchResult then = result();
  BenchResult now = then;
  now.device.software = !then.device.software;
  BenchComparison comparison = compare_benches(now, then);
  EXPECT_THAT(comparison.ratios, IsEmpty());
  EXPECT_THAT(comparison.unmatched, IsEmpty());
  EXPECT_EQ(comparison.incomparable, Incomparable::software);
  EXPECT_THAT(comparison.changes, IsEmpty());
  EXPECT_EQ(results::to_json(comparison, "old.json")["incomparable"], "software");
  // Results that cannot be compared do not pass.
  BenchReportOptions options;
  options.against = "old.json";
  options.fail_slower = 50;
  EXPECT_EQ(report_bench(options, now, then), ExitCode::check_failed);
  now = then;
  now.protocol.clock = "processor time";
  now.protocol.processor_time = true;
  comparison = compare_benches(now, then);
  EXPECT_THAT(comparison.ratios, IsEmpty());
  EXPECT_EQ(comparison.incomparable, Incomparable::clock);
  EXPECT_THAT(whats(comparison), ElementsAre(What::clock));
}

TEST(BenchComparison, DoesNotPairWhatIsNotTheSame) {
  const BenchResult then = result();
  BenchResult now = then;
  now.measurements[0].width = 641;  // same name, as "full" of other cameras
  now.measurements[1].configuration = "generic";
  const BenchComparison comparison = compare_benches(now, then);
  EXPECT_EQ(comparison.ratios.size(), 6u);
  using In = UnmatchedBench::In;
  EXPECT_THAT(comparison.unmatched,
              ElementsAre(unmatched(In::now, "tureen"), unmatched(In::now, "generic"),
                          unmatched(In::then, "tureen"), unmatched(In::then, "published")));
}

TEST(BenchComparison, InEnglish) {
  const BenchResult then = result();
  BenchResult now = then;
  now.protocol.clock = "processor time";
  now.protocol.processor_time = true;
  now.measurements.clear();
  EXPECT_THAT(comparison_lines(compare_benches(now, then)),
              ElementsAre("not compared: the two used different clocks",
                          "different clock: steady then, processor time now"));
}

// ---- The files ---------------------------------------------------------------------

TEST(BenchReports, WritesTheFolderAndFailsOnlyWhereAsked) {
  const TemporaryFolder folder;
  BenchResult then = result();
  Output old(folder / "old.json");
  old.write(results::to_json(then).dump());
  old.commit();
  BenchResult now = then;
  for (BenchMeasurement& m : now.measurements) m.frame_ms.min_of_medians *= 1.5;
  BenchReportOptions options{.folder = (folder / "new/out").string(),
                             .against = (folder / "old.json").string(),
                             .fail_slower = {}};
  // The program checks every name before it measures for minutes.
  std::filesystem::create_directories(folder / "new/out/bench.json");
  EXPECT_THROW(prepare_bench_reports(options, {}), OutputError);
  std::filesystem::remove(folder / "new/out/bench.json");
  const auto before = prepare_bench_reports(options, {});
  ASSERT_TRUE(before);
  EXPECT_EQ(report_bench(options, now, before), ExitCode::done);
  EXPECT_TRUE(std::filesystem::exists(folder / "new/out/bench.json"));
  options.folder.clear();
  options.fail_slower = 60;
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(report_bench(options, now, before), ExitCode::done);
  EXPECT_THAT(::testing::internal::GetCapturedStderr(), Not(HasSubstr("--fail-slower")));
  // A passed check reports the measurements that it could not compare.
  BenchResult fewer = now;
  fewer.measurements.erase(fewer.measurements.begin());
  fewer.measurements.front().frame_ms.spread = 0.31;
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(report_bench(options, fewer, before), ExitCode::done);
  EXPECT_THAT(::testing::internal::GetCapturedStderr(), Names("--fail-slower", 1, 7, "60 %"));
  options.fail_slower = 40;
  EXPECT_EQ(report_bench(options, now, before), ExitCode::check_failed);
  for (BenchMeasurement& m : now.measurements) m.frame_ms.rounds = 2;
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(report_bench(options, now, before), ExitCode::check_failed);
  EXPECT_THAT(::testing::internal::GetCapturedStderr(), Names("--fail-slower", 8, 3, "--seconds"));
  now.measurements.clear();
  EXPECT_EQ(report_bench(options, now, before), ExitCode::check_failed) << "no common measurement";
}

TEST(BenchReports, ABadFileIsRefusedBeforeAnythingIsMeasured) {
  const TemporaryFolder folder;
  Output bad(folder / "bad.json");
  bad.write("{\"format\": \"something else\"}");
  bad.commit();
  const auto prepare = [&](const char* name) {
    BenchReportOptions options;
    options.against = (folder / name).string();
    prepare_bench_reports(options, {});
  };
  EXPECT_THAT(test::error_of<InputError>([&] { prepare("bad.json"); }), test::ErrorIn("bad.json"));
  EXPECT_THAT(test::error_of<InputError>([&] { prepare("none.json"); }),
              test::ErrorIn("none.json"));
}

}  // namespace bench_report_test
}  // namespace tureen::cli
