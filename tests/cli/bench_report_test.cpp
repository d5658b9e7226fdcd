// What is made of a result of `tureen bench`: CSV, plots, the page, the comparison.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include "cli/bench_comparison.hpp"
#include "cli/bench_csv.hpp"
#include "cli/bench_markdown.hpp"
#include "cli/bench_page.hpp"
#include "cli/bench_plots.hpp"
#include "cli/bench_reports.hpp"
#include "cli/bench_words.hpp"
#include "formats/format_testing.hpp"
#include "formats/output.hpp"
#include "soup/error.hpp"
#include "support/markup.hpp"

namespace tureen::cli {
namespace {

using test::check_markup;
using test::Markup;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;
using tureen::testing::TemporaryFolder;

/// Names that try to leave the place where they belong.
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
          .passes_reason = "timers mislead <here>",
          .gpu_ms = {},
          .views_ms = {0.9 * ms, ms, 1.1 * ms},
          .pixels_hash = "0123456789abcdef",
          .picture = {}};
}

BenchResult result() {
  BenchResult result;
  result.date = "2026-01-02T03:04:05Z";
  result.program = {"0.1.0", "abc1234", {"bench", "it's a scene.glb", "--sweep"}};
  result.scene = {awkward, awkward, 15000, "lattice"};
  result.machine = {"Some CPU & more", 2, 4096};
  result.device = {"EGL", "llvmpipe <256 bits>", "Mesa", "4.5 driver 9", true};
  result.protocol = {"steady", 5, 0.02};
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

// ---- CSV ----------------------------------------------------------------------------------------

/// Fields of RFC 4180, line by line.
std::vector<std::vector<std::string>> parse_csv(const std::string& text) {
  std::vector<std::vector<std::string>> lines(1, {""});
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted && c == '"' && i + 1 < text.size() && text[i + 1] == '"')
      lines.back().back() += text[++i];
    else if (c == '"')
      quoted = !quoted;
    else if (c == ',' && !quoted)
      lines.back().emplace_back();
    else if (c == '\n' && !quoted)
      lines.push_back({""});
    else
      lines.back().back() += c;
  }
  lines.pop_back();
  return lines;
}

TEST(BenchCsv, HasTheseColumns) {
  const auto lines = parse_csv(bench_csv(result()));
  EXPECT_THAT(lines[0], ElementsAre("configuration", "camera_set", "size", "width", "height",
                                    "views", "rounds", "frames", "mean_ms", "median_ms", "p95_ms",
                                    "p99_ms", "min_of_medians_ms", "spread", "aa_spread", "fps",
                                    "low_1_percent_fps", "stable", "gpu_ms", "pixels_hash", "scene",
                                    "triangles", "renderer", "cpu", "commit", "date", "driver",
                                    "plan", "build", "rasteriser_threads"));
  ASSERT_EQ(lines.size(), 9u);
  for (const auto& line : lines) EXPECT_EQ(line.size(), lines[0].size());
  EXPECT_THAT(std::vector(lines[1].begin(), lines[1].begin() + 8),
              ElementsAre("tureen", "hemisphere:3", "640x360", "640", "360", "3", "5", "15"));
  EXPECT_EQ(lines[1][26], "4.5 driver 9");
  EXPECT_EQ(lines[1][27], "M1: no <network>");
  EXPECT_EQ(lines[2][27], "") << "the plan is the configuration's own";
}

TEST(BenchCsv, IsEmptyWhereNothingIsKnown) {
  BenchResult told = result();
  told.program.build = "release";
  told.machine.rasteriser_threads = 2;
  told.measurements[1].frame_ms.samples = 120;
  const auto lines = parse_csv(bench_csv(told));
  EXPECT_EQ(lines[1][11], "") << "the p99 of 15 samples";
  EXPECT_EQ(lines[1][16], "") << "their 1 % low";
  EXPECT_DOUBLE_EQ(std::stod(lines[2][11]), told.measurements[1].frame_ms.p99);
  EXPECT_DOUBLE_EQ(std::stod(lines[2][16]), told.measurements[1].frame_ms.low_1_percent_fps);
  EXPECT_EQ(lines[1][28], "release");
  EXPECT_EQ(lines[1][29], "2");
  EXPECT_EQ(parse_csv(bench_csv(result()))[1][29], "");
}

TEST(BenchCsv, KeepsDigitsAndAwkwardNames) {
  BenchResult changed = result();
  changed.measurements[0].frame_ms.median = 1.0 / 3;
  const auto lines = parse_csv(bench_csv(changed));
  EXPECT_EQ(std::stod(lines[1][9]), 1.0 / 3);
  EXPECT_EQ(lines[1][18], "7.25");
  EXPECT_EQ(lines[2][18], "") << "not measured";
  EXPECT_EQ(lines[1][20], awkward);
  EXPECT_EQ(lines[5][1], awkward);
}

TEST(BenchMarkdown, IsATableWhateverTheNamesAre) {
  BenchResult all = result();
  all.measurements[0].camera_set = "a|b\n";
  std::istringstream text(bench_markdown(all));
  std::string line;
  std::size_t rows = 0;
  while (std::getline(text, line)) {
    if (line.empty() || line[0] != '|') continue;
    std::size_t bars = 0;
    for (std::size_t i = 0; i < line.size(); ++i)
      bars += line[i] == '|' && (i == 0 || line[i - 1] != '\\');
    EXPECT_EQ(bars, 15u) << line;
    ++rows;
  }
  EXPECT_EQ(rows, 2 + all.measurements.size());
  EXPECT_THAT(bench_markdown(all), HasSubstr("| 4.00 |"));
}

TEST(BenchMarkdown, SaysOfHowMuchItsFiguresAre) {
  BenchResult all = result();
  all.machine.rasteriser_threads = 3;
  all.program.build = "release";
  EXPECT_THAT(bench_markdown(all), HasSubstr("2 cores, 3 rasteriser threads; commit abc1234, "
                                             "release build, 2026"));
  EXPECT_THAT(bench_markdown(all),
              HasSubstr("| 640x360 | tureen | 5 | 15 | 10.1 | 10.0 | 12.0 | – | 98.0 | – | 2.0 % | "
                        "1.0 % | 4.00 |"));
  EXPECT_THAT(bench_markdown(all), Not(HasSubstr(restless_mark)));
  all.measurements[0].frame_ms.samples = 100;
  all.measurements[0].stable = false;
  const std::string text = bench_markdown(all);
  EXPECT_THAT(text, HasSubstr("| tureen† | 5 | 15 | 10.1 | 10.0 | 12.0 | 13.0 | 98.0 | 76.9 |"));
  EXPECT_THAT(text, EndsWith(std::string("|\n\n") + restless_sentence + "\n"));
}

TEST(BenchMarkdown, ClaimsNoDifferenceThatASpreadExplainsOrThatHasNone) {
  BenchResult all = result();
  all.measurements.resize(2);  // ours and the published, four times as long
  const auto last_cells = [&] {
    std::string cells;
    std::istringstream text(bench_markdown(all));
    for (std::string line; std::getline(text, line);)
      if (line.starts_with("| hemisphere"))
        cells += line.substr(line.rfind('|', line.size() - 2) + 2, 7) + ";";
    return cells;
  };
  EXPECT_EQ(last_cells(), "4.00 |;1.00 |;");
  all.measurements[1].frame_ms.spread = 1.6;  // of the reference
  EXPECT_EQ(last_cells(), "equal |;1.00 |;");
  all.measurements[1].frame_ms.spread = 0;
  all.measurements[1].frame_ms.rounds = 2;
  EXPECT_EQ(last_cells(), "2 round;1.00 |;");
  EXPECT_THAT(bench_markdown(all), HasSubstr("| – | 1.00 |")) << "two rounds have no spread";
}

// ---- Plots --------------------------------------------------------------------------------------

TEST(BenchPlots, AreAllThereUnderNamesOfTheirOwn) {
  std::vector<std::string> files;
  for (const Figure& plot : bench_plots(result())) files.push_back(plot.file);
  EXPECT_THAT(files, ElementsAre("pixels-hemisphere-3", "views-hemisphere-3", "pixels-a-b-i-c-d",
                                 "views-a-b-i-c-d", "ratios"));
  BenchResult twins = result();
  for (std::size_t i = 4; i < 8; ++i) twins.measurements[i].camera_set = "hemisphere/3";
  std::set<std::string> distinct;
  for (const Figure& plot : bench_plots(twins)) distinct.insert(plot.file);
  EXPECT_EQ(distinct.size(), 5u);
}

TEST(BenchPlots, NameTheAdversarialViewsAndNumberOthers) {
  BenchResult made = result();
  made.measurements.resize(1);
  made.measurements[0].views_ms = {4, 1, 2, 8};
  ASSERT_EQ(bench_plots(made).size(), 1u) << "one size says nothing about pixels";
  EXPECT_THAT(bench_plots(made)[0].plot.script, HasSubstr("set xlabel 'view'"));
  made.measurements[0].camera_set = "adversarial";
  const std::string script = bench_plots(made)[0].plot.script;
  EXPECT_THAT(script, HasSubstr(R"(("inside" 0, "far" 1, "grazing" 2, "most overdraw" 3))"));
  EXPECT_THAT(script, Not(HasSubstr("set xlabel 'view'")));
}

/// Of the first label that is rotated: letters of 13 pixels were 7.4 wide on average.
TEST(BenchPlots, RatiosHaveRoomForTheirLabels) {
  BenchResult made = result();
  for (std::size_t i = 0; i < made.measurements.size(); ++i)
    made.measurements[i].camera_set = "hemisphere:" + std::to_string(1000 + i);
  const std::vector<Figure> plots = bench_plots(made);
  ASSERT_EQ(plots.back().file, "ratios");
  const auto svg = draw_plot(plots.back().plot, PlotFormat::svg);
  if (!svg) GTEST_SKIP() << "no gnuplot";
  std::smatch label;
  ASSERT_TRUE(std::regex_search(*svg, label,
                                std::regex(R"re(translate\(([0-9.]+),[0-9.]+\) rotate\(-30\))re")));
  const double letters = double(std::string("hemisphere:1000 640x360").size());
  EXPECT_GT(std::stod(label[1]), 0.87 * 0.57 * 13 * letters);
}

TEST(BenchPlots, OneSizeOneViewAndOneConfigurationNeedNone) {
  BenchResult small = result();
  small.measurements.resize(1);
  small.measurements[0].views_ms = {1};
  EXPECT_THAT(bench_plots(small), IsEmpty());
  small.measurements.clear();
  EXPECT_THAT(bench_plots(small), IsEmpty());
}

TEST(BenchPlots, RatiosReferToThePublishedPipeline) {
  const BenchResult all = result();
  EXPECT_EQ(reference_configuration(all), "published");
  EXPECT_DOUBLE_EQ(times_as_fast(all, all.measurements[0]), 4);
  EXPECT_DOUBLE_EQ(times_as_fast(all, all.measurements[1]), 1);
  BenchResult alone = all;
  alone.measurements.resize(1);
  EXPECT_EQ(reference_configuration(alone), "tureen");
}

TEST(BenchPlots, GnuplotDrawsThemAll) {
  for (const Figure& each : bench_plots(result())) {
    const std::optional<std::string> svg = draw_plot(each.plot, PlotFormat::svg);
    if (!svg) GTEST_SKIP() << gnuplot_missing;
    const Markup markup = check_markup(*svg);
    EXPECT_EQ(markup.defect, "") << each.file;
    EXPECT_THAT(markup.text, HasSubstr("published")) << each.file;
  }
}

// ---- Comparison ---------------------------------------------------------------------------------

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
  EXPECT_THAT(comparison.circumstances, IsEmpty());
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
  EXPECT_THAT(comparison_lines(comparison)[0],
              HasSubstr("9.000 times as long: 1 round (too few for a spread)"));
  EXPECT_THAT(comparison_lines(comparison)[1], HasSubstr("slower (spread 2.0 %)"));
  EXPECT_EQ(slower_than(comparison, 0).size(), now.measurements.size() - 1);
}

TEST(BenchComparison, SaysWhatBuildAndThreadsChanged) {
  BenchResult then = result();
  BenchResult now = then;
  now.program.build = "debug";
  now.machine.rasteriser_threads = 4;
  EXPECT_THAT(compare_benches(now, then).circumstances, IsEmpty()) << "an older file";
  then.program.build = "release";
  then.machine.rasteriser_threads = 2;
  EXPECT_THAT(compare_benches(now, then).circumstances,
              ElementsAre("another number of rasteriser threads: 2 then, 4 now",
                          "another build: release then, debug now"));
}

TEST(BenchComparison, SaysWhatElseChanged) {
  const BenchResult then = result();
  BenchResult now = then;
  now.scene.triangles = 14000;
  now.machine.cores = 4;
  now.device.version = "another";
  now.program.commit = "def5678";
  EXPECT_THAT(compare_benches(now, then).circumstances,
              ElementsAre(HasSubstr("another scene"), HasSubstr("another machine"),
                          HasSubstr("another driver"),
                          HasSubstr("another commit: abc1234 then, def5678 now")));
}

TEST(BenchComparison, SoftwareAndHardwareAreNotCompared) {
  const BenchResult then = result();
  BenchResult now = then;
  now.device.software = !then.device.software;
  BenchComparison comparison = compare_benches(now, then);
  EXPECT_THAT(comparison.ratios, IsEmpty());
  EXPECT_THAT(comparison.unmatched, IsEmpty());
  EXPECT_THAT(comparison.circumstances, ElementsAre(StartsWith("not compared: one of the two")));
  // What nobody could judge has not passed.
  BenchReportOptions options;
  options.against = "old.json";
  options.fail_slower = 50;
  EXPECT_EQ(report_bench(options, now, then), ExitCode::check_failed);
  BenchPage page;
  page.comparison = &comparison;
  EXPECT_THAT(bench_page(now, page),
              AllOf(HasSubstr("Nothing can be compared."), Not(HasSubstr("then ms"))));
  EXPECT_THAT(comparison_markdown(comparison, "old.json"),
              AllOf(HasSubstr("old.json: nothing can be compared."), Not(HasSubstr("ms then"))));
  now = then;
  now.protocol.clock = "processor time";
  comparison = compare_benches(now, then);
  EXPECT_THAT(comparison.ratios, IsEmpty());
  EXPECT_THAT(comparison.circumstances,
              ElementsAre(StartsWith("not compared: their times"), StartsWith("another clock")));
}

TEST(BenchComparison, DoesNotPairWhatIsNotTheSame) {
  const BenchResult then = result();
  BenchResult now = then;
  now.measurements[0].width = 641;  // under the same name, as "full" of other cameras would be
  now.measurements[1].configuration = "generic";
  const BenchComparison comparison = compare_benches(now, then);
  EXPECT_EQ(comparison.ratios.size(), 6u);
  EXPECT_THAT(comparison.unmatched,
              ElementsAre(StartsWith("only now: tureen"), StartsWith("only now: generic"),
                          StartsWith("only then: tureen"), StartsWith("only then: published")));
}

TEST(BenchPage, TellsWhatIsNotKnown) {
  BenchResult all = result();
  all.measurements.resize(2);
  all.measurements[0].frame_ms.rounds = 1;
  all.peak_mib = 77;
  all.program.build = "debug";
  all.machine.rasteriser_threads = 3;
  const BenchComparison comparison = compare_benches(all, all);
  const std::string html = bench_page(all, {.figures = {},
                                            .pictures = {},
                                            .compared_with = "old.json",
                                            .comparison = &comparison,
                                            .missing = {}});
  EXPECT_EQ(check_markup(html).defect, "");
  for (const char* part : {">1 round<", ">–<", "77 MiB", "debug build", "3 rasteriser threads",
                           "of fewer than 3 rounds none is known"})
    EXPECT_THAT(html, HasSubstr(part));
  EXPECT_THAT(html, Not(HasSubstr(">4.00<"))) << "of one round";
}

TEST(BenchPage, PutsAReasonBesideThePassesThatAreTheLesserPart) {
  BenchResult all = result();
  all.measurements[0].passes_reason = "they miss something";
  EXPECT_THAT(bench_page(all, {}), HasSubstr("shading 3.000 (they miss something)"));
}

// ---- The page and the files ---------------------------------------------------------------------

TEST(BenchPage, HoldsAllThatTheFiguresDependOn) {
  const BenchResult all = result();
  BenchResult then = all;
  then.program.commit = "older";
  const BenchComparison comparison = compare_benches(all, then);
  const std::string html = bench_page(all, {.figures = {{"<svg></svg>", awkward}},
                                            .pictures = {{{std::byte{1}}, awkward}},
                                            .compared_with = awkward,
                                            .comparison = &comparison,
                                            .missing = {}});
  const Markup markup = check_markup(html);
  EXPECT_EQ(markup.defect, "");
  EXPECT_THAT(markup.links, Each(StartsWith("data:")));
  EXPECT_THAT(html, Not(HasSubstr("http://")));
  EXPECT_THAT(html, Not(HasSubstr("https://")));
  for (const char* part : {"Some CPU &amp; more", "llvmpipe &lt;256 bits&gt;", "4.5 driver 9",
                           "abc1234", "M1: no &lt;network&gt;", "2026-01-02T03:04:05Z", "15,000",
                           "software rasteriser", "timers mislead &lt;here&gt;", "another commit",
                           "tureen bench &#39;it&#39;\\&#39;&#39;s a scene.glb&#39; --sweep"})
    EXPECT_THAT(html, HasSubstr(part));
}

TEST(BenchReports, WritesTheFolderAndFailsOnlyWhereAsked) {
  const TemporaryFolder folder;
  BenchResult then = result();
  Output old(folder / "old.json");
  old.write(to_json(then).dump());
  old.commit();
  BenchResult now = then;
  for (BenchMeasurement& m : now.measurements) m.frame_ms.min_of_medians *= 1.5;
  BenchReportOptions options{.folder = (folder / "new/out").string(),
                             .csv = (folder / "table.csv").string(),
                             .plots = {},
                             .against = (folder / "old.json").string(),
                             .fail_slower = {}};
  // Every name is tried before minutes of measuring.
  std::filesystem::create_directories(folder / "new/out/bench.csv");
  EXPECT_THROW(prepare_bench_reports(options, {}), OutputError);
  EXPECT_FALSE(std::filesystem::exists(folder / "new/out/bench.json"));
  std::filesystem::remove(folder / "new/out/bench.csv");
  const auto before = prepare_bench_reports(options, {});
  ASSERT_TRUE(before);
  EXPECT_EQ(report_bench(options, now, before), ExitCode::done);
  std::ifstream file(folder / "new/out/bench.md");
  EXPECT_THAT(std::string(std::istreambuf_iterator<char>(file), {}),
              AllOf(HasSubstr("| configuration | cameras | size | ms then |"),
                    HasSubstr(" | 1.500 | "), HasSubstr("old.json:")));
  for (const char* name : {"new/out/bench.json", "new/out/bench.csv", "new/out/bench.md",
                           "new/out/bench.html", "table.csv"})
    EXPECT_TRUE(std::filesystem::exists(folder / name)) << name;
  if (draw_plot({.title = "a", .script = "plot 1"}, PlotFormat::svg)) {
    EXPECT_TRUE(std::filesystem::exists(folder / "new/out/ratios.svg"));
    EXPECT_TRUE(std::filesystem::exists(folder / "new/out/ratios.png"));
  }
  options.folder.clear();
  options.csv.clear();
  options.fail_slower = 60;
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(report_bench(options, now, before), ExitCode::done);
  EXPECT_THAT(::testing::internal::GetCapturedStderr(), Not(HasSubstr("--fail-slower")));
  // A pass says what it could not have seen.
  BenchResult fewer = now;
  fewer.measurements.erase(fewer.measurements.begin());
  fewer.measurements.front().frame_ms.spread = 0.31;
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(report_bench(options, fewer, before), ExitCode::done);
  EXPECT_THAT(::testing::internal::GetCapturedStderr(),
              AllOf(HasSubstr("of 1 of 7 twice the spread is more than 60 %"),
                    HasSubstr("1 row that only one of the two measured is not judged")));
  options.fail_slower = 40;
  EXPECT_EQ(report_bench(options, now, before), ExitCode::check_failed);
  for (BenchMeasurement& m : now.measurements) m.frame_ms.rounds = 2;
  ::testing::internal::CaptureStderr();
  EXPECT_EQ(report_bench(options, now, before), ExitCode::check_failed);
  EXPECT_THAT(::testing::internal::GetCapturedStderr(),
              HasSubstr("--fail-slower cannot judge 8 of 8, of fewer than 3 rounds"));
  now.measurements.clear();
  EXPECT_EQ(report_bench(options, now, before), ExitCode::check_failed) << "nothing in both";
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
  EXPECT_THAT(tureen::testing::input_error([&] { prepare("bad.json"); }),
              HasSubstr("no result of tureen bench"));
  EXPECT_THAT(tureen::testing::input_error([&] { prepare("none.json"); }), HasSubstr("none.json"));
}

}  // namespace
}  // namespace tureen::cli
