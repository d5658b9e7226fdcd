#include "cli/plot_axis.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

namespace tureen::cli {
namespace {

using testing::ElementsAre;

std::vector<std::string> labels(const PlotAxis& axis) {
  std::vector<std::string> result;
  for (const Tick& tick : axis.ticks()) result.push_back(tick.label);
  return result;
}

TEST(PlotAxis, LabelsRoundNumbers) {
  EXPECT_THAT(labels(PlotAxis::linear(0, 10000, 6)),
              ElementsAre("0", "2000", "4000", "6000", "8000", "10k"));
  EXPECT_THAT(labels(PlotAxis::linear(0, 60000, 3)), ElementsAre("0", "20k", "40k", "60k"));
  EXPECT_THAT(labels(PlotAxis::linear(-0.25, 0.31, 6)),
              ElementsAre("-0.2", "-0.1", "0", "0.1", "0.2", "0.3"));
  EXPECT_THAT(labels(PlotAxis::linear(11.2, 29.7, 5)), ElementsAre("15", "20", "25"));
  EXPECT_THAT(labels(PlotAxis::logarithmic(0.018, 0.3, 7)),
              ElementsAre("0.02", "0.03", "0.05", "0.07", "0.1", "0.2", "0.3"));
  EXPECT_THAT(labels(PlotAxis::logarithmic(1e-4, 10, 7)),
              ElementsAre("0.0001", "0.001", "0.01", "0.1", "1", "10"));
}

TEST(PlotAxis, ChoosesTheUnitOfTime) {
  EXPECT_EQ(PlotAxis::duration(100, 5).unit(), "seconds");
  const PlotAxis minutes = PlotAxis::duration(1800, 6);
  EXPECT_EQ(minutes.unit(), "minutes");
  EXPECT_THAT(labels(minutes), ElementsAre("0", "5", "10", "15", "20", "25", "30"));
  EXPECT_EQ(minutes.position(minutes.ticks()[3].value), 0.5);
  EXPECT_EQ(PlotAxis::duration(20000, 5).unit(), "hours");
  EXPECT_EQ(PlotAxis::duration(0, 5).position(0), 0);
}

TEST(PlotAxis, PutsValuesInTheirPlace) {
  const PlotAxis linear = PlotAxis::linear(10, 30, 5);
  EXPECT_EQ(linear.position(10), 0);
  EXPECT_EQ(linear.position(15), 0.25);
  EXPECT_EQ(linear.position(50), 2);
  const PlotAxis decades = PlotAxis::logarithmic(0.01, 1, 5);
  EXPECT_NEAR(decades.position(0.1), 0.5, 1e-12);
  // One value alone still lies in the middle of something.
  EXPECT_EQ(PlotAxis::linear(7, 7, 5).position(7), 0.5);
  EXPECT_NEAR(PlotAxis::logarithmic(0.2, 0.2, 5).position(0.2), 0.5, 1e-12);
}

TEST(PlotAxis, TicksLieWithinAndAreFew) {
  std::mt19937 random(20261121);
  std::uniform_real_distribution<double> exponent(-6, 6);
  for (int round = 0; round < 1000; ++round) {
    const double low = std::pow(10, exponent(random)), span = std::pow(10, exponent(random));
    SCOPED_TRACE(testing::Message() << "from " << low << " over " << span);
    for (const PlotAxis& axis :
         {PlotAxis::linear(low, low + span, 6), PlotAxis::duration(span, 6)}) {
      EXPECT_GE(axis.ticks().size(), 1u);
      EXPECT_LE(axis.ticks().size(), 7u);  // one more than steps
      for (const Tick& tick : axis.ticks()) {
        EXPECT_GE(axis.position(tick.value), -1e-6);
        EXPECT_LE(axis.position(tick.value), 1 + 1e-6);
      }
    }
  }
}

}  // namespace
}  // namespace tureen::cli
