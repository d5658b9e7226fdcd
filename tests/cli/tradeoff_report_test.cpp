// The JSON of an invented study.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "cli/tradeoff/tradeoff_tables.hpp"
#include "jobs/tradeoff/model_errors.hpp"
#include "jobs/tradeoff/references.hpp"
#include "tests/support/errors.hpp"

namespace tureen::cli {
namespace tradeoff_report_test {

using test::Names;
using testing::ElementsAre;

tradeoff::Outcome outcome(tradeoff::Configuration configuration, const std::string& name, double ms,
                          double psnr) {
  tradeoff::Outcome result;
  result.configuration = std::move(configuration);
  result.name = name;
  result.ms = {.mean = ms,
               .median = ms,
               .p95 = 1.2 * ms,
               .p99 = 1.3 * ms,
               .min_of_medians = ms,
               .spread = 0.1,
               .low_1_percent_fps = 1};
  result.device_mib = 2;
  result.error.psnr_db = psnr;
  result.error.view_psnr_db = {psnr};
  result.error.ssim = 0.9;
  return result;
}

tradeoff::Panel panel() {
  tradeoff::Panel result;
  result.settings = {{"lattice_level", "lattice level", {{"3", "level 3"}, {"2", "level 2"}}},
                     {"texel_bits", "texel bits", {{"8", "8 bits"}, {"4", "4 bits"}}}};
  result.outcomes = {outcome({0, 0}, "defaults", 10, 60), outcome({0, 0}, "defaults", 20, 60),
                     outcome({1, 0}, "level 2", 8, 40), outcome({0, 1}, "4 bits", 9, 50),
                     outcome({1, 1}, "level 2, \"4 bits\"", 7, 39)};
  result.outcomes[1].factor = tradeoff::Factor::generic;
  result.ranges = {{0, 1.25, 20}, {1, 1.1, 10}};
  result.front = {4, 2, 3, 0};
  result.ideal.psnr_db = 61;
  result.ideal.view_psnr_db = {61};
  return result;
}

TradeoffReport report() {
  TradeoffReport result;
  result.date = "2026-06-01T12:00:00Z";
  result.program = {"0.1.0", "abc", {"tradeoff", "a<b.glb"}};
  result.scene = {"a<b", "a<b.glb", 12, "lattice texture"};
  result.device = {.context = "OSMesa",
                   .renderer = "llvmpipe",
                   .vendor = "Mesa",
                   .version = "4.5",
                   .software = true};
  result.camera_set = "hemisphere:1";
  result.width = 64;
  result.height = 48;
  result.views = result.rounds = 1;
  result.clock = "sundial";
  result.samples = "device";
  result.study.drawing = panel();
  tradeoff::Outcome published = outcome({0, 0}, "baseline", 90, 55);
  published.factor = tradeoff::Factor::baseline;
  result.study.drawing.outcomes.push_back(published);
  for (tradeoff::Outcome& each : result.study.drawing.outcomes)
    each.exact = tradeoff::ExactError{each.error.psnr_db - 10, 0.25};
  result.study.baseline = 5;
  result.study.antialiasing = panel();
  result.study.antialiasing.skipped = {{"half the resolution", "this device has none"}};
  result.study.grid.view_psnr_db = {50};
  result.study.choice = 3;
  return result;
}

TEST(TradeoffReport, SaysWhatWasMeasured) {
  const Json json = results::to_json(report());
  const Json& configurations = json["drawing"]["configurations"];
  EXPECT_EQ(configurations[2]["knobs"], (Json{{"lattice_level", "2"}, {"texel_bits", "8"}}));
  EXPECT_EQ(configurations[2]["ms_p95"], 1.2 * 8);
  EXPECT_EQ(configurations[2]["ms_spread"], 0.1 * 8);
  EXPECT_EQ(configurations[1]["method"], "tureen --no-specialise");
  EXPECT_EQ(configurations[5]["method"], "published");
  EXPECT_EQ(configurations[2]["on_front"], true);
  EXPECT_EQ(configurations[1]["on_front"], false);
  EXPECT_EQ(configurations[0]["e_model"], nullptr);
  EXPECT_EQ(configurations[2]["e_render_exact"], (Json{{"psnr_db", 30.0}, {"coverage", 0.25}}));
  EXPECT_EQ(json["antialiasing"]["configurations"][2]["e_render_exact"], nullptr);
  EXPECT_EQ(json["choice"]["psnr_db"], 50);
  EXPECT_EQ(json["r0"], 5);
  EXPECT_EQ(json["protocol"]["clock"], "sundial");
}

TEST(TradeoffReport, TimesOfABusyMachineAreWarnedOf) {
  EXPECT_FALSE(tradeoff::spread_warning(0.05));
  EXPECT_THAT(tradeoff::spread_warning(0.234).value_or(""), Names("23 %"));
}

TEST(TradeoffReport, TheChoiceIsASentence) {
  TradeoffReport made = report();
  EXPECT_THAT(choice_sentence(made), Names("4 bits", "9.00 ms", "50.00 dB", "10.0 ms"));
  made.study.choice.reset();
  EXPECT_THAT(choice_sentence(made), Names(made.limits.min_psnr_db));
}

TEST(TradeoffReport, WarnsOfOutcomesThatMeanLess) {
  tradeoff::Panel made = panel();
  tradeoff::Outcome& doubtful = made.outcomes[2];
  EXPECT_THAT(tradeoff::warnings_about(doubtful), testing::IsEmpty());
  doubtful.stable = false;
  EXPECT_EQ(tradeoff::warnings_about(doubtful).size(), 1u);
  doubtful.error.non_finite = 37;
  EXPECT_THAT(tradeoff::warnings_about(doubtful), ElementsAre(testing::_, Names(37)));
}

TEST(TradeoffCandidates, AreWhatCanBeChosen) {
  TradeoffReport made = report();
  made.study.drawing.outcomes[4].factor = tradeoff::Factor::baseline;
  made.study.drawing.aa_spread = 0.01;
  const tradeoff::Candidates all = tradeoff::candidates(made.study.drawing);
  EXPECT_THAT(all.index, ElementsAre(0, 2, 3));
  EXPECT_DOUBLE_EQ(all.points[0].spread_ms, 0.2);
  EXPECT_EQ(all.points[1].departures, 1);
}

tradeoff::Panel supersampled() {
  tradeoff::Panel result;
  result.settings = tradeoff::antialiasing_settings(8, false);
  const std::vector<tradeoff::Configuration> star{{0, 0}, {0, 1}, {0, 2}, {0, 3}};
  double ms = 5, psnr = 30;
  for (const tradeoff::Configuration& each : star) {
    result.outcomes.push_back(
        outcome(each, tradeoff::describe(result.settings, each), ms *= 2, psnr += 8));
    result.outcomes.back().applied = tradeoff::applied_by(result.settings, each);
  }
  return result;
}

// With a reference of 8 x 8 samples, 8 x 8 samples differ only by rounding, at any cost.
TEST(TradeoffCandidates, TheReferencesOwnSamplesAreOnNoFront) {
  tradeoff::Panel made = supersampled();
  ASSERT_EQ(made.outcomes[3].applied.quality.supersampling, tradeoff::antialiased_samples);
  EXPECT_FALSE(tradeoff::is_judged(made.outcomes[3]));
  EXPECT_TRUE(tradeoff::is_judged(made.outcomes[2]));
  tradeoff::find_front(made);
  EXPECT_THAT(made.front, ElementsAre(0, 1, 2));
}

TEST(SpreadOut, TakesPhotographsEvenly) {
  std::vector<Photograph> photographs(10);
  for (int i = 0; i < 10; ++i) photographs[std::size_t(i)].camera.name = std::to_string(i);
  const auto names = [&](std::size_t most) {
    std::string text;
    for (const Photograph& each : tradeoff::spread_out(photographs, most)) text += each.camera.name;
    return text;
  };
  EXPECT_EQ(names(0), "0123456789");
  EXPECT_EQ(names(20), "0123456789");
  EXPECT_EQ(names(4), "0257");
  EXPECT_EQ(names(1), "0");
}

}  // namespace tradeoff_report_test
}  // namespace tureen::cli
