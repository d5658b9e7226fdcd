#include "cli/training_plot.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <regex>

#include "support/markup.hpp"

namespace tureen::cli {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

TrainingRun run_of(const std::string& name, int steps, double final_psnr) {
  TrainingRun run{name, {}};
  for (int step = 10; step <= steps; step += 10) {
    const double psnr = final_psnr - 15 * std::exp(-step / 500.0);
    TrainingRecord record{
        .step = step, .seconds = step / 10.0, .loss = 0.3 * std::exp(-step / 900.0)};
    record.train_psnr_db = psnr;
    if (step % 500 == 0) record.test_psnr_db = psnr - 1;
    run.records.push_back(record);
  }
  return run;
}

struct Dot {
  double x, y;
};

std::vector<Dot> dots(const std::string& svg) {
  static const std::regex circle("<circle [^>]*cx=\"([0-9.-]+)\" cy=\"([0-9.-]+)\"");
  std::vector<Dot> result;
  for (std::sregex_iterator it(svg.begin(), svg.end(), circle), end; it != end; ++it)
    result.push_back({std::stod((*it)[1]), std::stod((*it)[2])});
  return result;
}

TEST(Smoothed, IsAMeanThatBeginsWithoutBias) {
  const std::vector<double> values{8, 8, 8};
  EXPECT_THAT(smoothed(values, 10),
              ElementsAre(DoubleNear(8, 1e-12), DoubleNear(8, 1e-12), DoubleNear(8, 1e-12)));
  // Window 2: weights 1/2, 1 and 1/4, 1/2, 1.
  const std::vector<double> steps{0, 3, 7};
  EXPECT_THAT(smoothed(steps, 2),
              ElementsAre(0, DoubleNear(2, 1e-12), DoubleNear((3 * 0.5 + 7) / 1.75, 1e-12)));
  EXPECT_EQ(smoothed(steps, 1), steps);
  const std::vector<double> broken{1, nan, 1};
  const std::vector<double> result = smoothed(broken, 2);
  EXPECT_TRUE(std::isnan(result[1]));
  EXPECT_NEAR(result[2], 1, 1e-12);
}

TEST(TrainingPlot, IsOneWholeSvg) {
  const std::vector<TrainingRun> runs{run_of("ours", 5000, 29), run_of("a <b> & \"c\"", 2500, 27)};
  const std::string svg = training_plot(runs);
  EXPECT_EQ(test::check_markup(svg).defect, "");
  EXPECT_THAT(svg, HasSubstr("a &lt;b&gt; &amp; &quot;c&quot;"));
  EXPECT_THAT(svg, HasSubstr("prefers-color-scheme:dark"));
  EXPECT_THAT(svg, Not(HasSubstr("http://www.w3.org/1999/xlink")));
  EXPECT_THAT(svg, HasSubstr("ours: step 5000, 500 s, 28.00 dB"));
  EXPECT_THAT(svg, HasSubstr(">minutes<"));
}

TEST(TrainingPlot, HeldOutViewsLieWhereTheyBelong) {
  TrainingRun run{"run", {}};
  for (const auto& [seconds, psnr] : {std::pair{0.0, 20.0}, {50.0, 25.0}, {100.0, 30.0}})
    run.records.push_back({.step = int(seconds) + 1,
                           .seconds = seconds,
                           .loss = 0.1,
                           .train_psnr_db = psnr,
                           .test_psnr_db = psnr});
  // The legend's sample has no cy.
  const std::vector<Dot> found = dots(training_plot(std::vector{run}));
  ASSERT_EQ(found.size(), 3u);
  // The panel is 382 x 290 pixels at (548, 52): 100 s fill its width, 11 dB (half a decibel to
  // spare on either side) its height. Coordinates have one decimal.
  EXPECT_NEAR(found[0].x, 548, 0.06);
  EXPECT_NEAR(found[1].x, 548 + 191, 0.06);
  EXPECT_NEAR(found[2].x, 548 + 382, 0.06);
  EXPECT_NEAR(found[0].y, 52 + 290 * (10.5 / 11), 0.06);
  EXPECT_NEAR(found[1].y, 52 + 290 * (5.5 / 11), 0.06);
  EXPECT_NEAR(found[2].y, 52 + 290 * (0.5 / 11), 0.06);
}

TEST(TrainingPlot, SurvivesRunsThatWentWrong) {
  TrainingRun run = run_of("wrong", 200, 25);
  for (std::size_t i = 5; i < run.records.size(); ++i) {
    run.records[i].loss = i % 2 ? nan : 0.0;
    run.records[i].train_psnr_db = nan;
    run.records[i].test_psnr_db = nan;
  }
  TrainingRun hopeless{"hopeless", {{.step = 1, .loss = nan, .train_psnr_db = nan}}};
  for (const std::vector<TrainingRun>& runs :
       {std::vector{run}, std::vector{hopeless}, std::vector{hopeless, run}}) {
    const std::string svg = training_plot(runs);
    EXPECT_EQ(test::check_markup(svg).defect, "");
    EXPECT_FALSE(std::regex_search(svg, std::regex("[\"ML ](-?nan|-?inf)"))) << svg;
  }
}

TEST(TrainingPlot, DoesNotGrowWithTheLog) {
  EXPECT_LT(training_plot(std::vector{run_of("long", 1'000'000, 29)}).size(), 400'000u);
  const std::string few = training_plot(std::vector{run_of("short", 4'000, 29)});
  const std::string many = training_plot(std::vector{run_of("longer", 8'000, 29)});
  // Twice the records, 8 dots of about 170 bytes more.
  EXPECT_LT(many.size(), few.size() + 8 * 250);
}

}  // namespace
}  // namespace tureen::cli
