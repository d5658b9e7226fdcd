// What the page says where nothing could be fitted.
#include "bench/page/growth_section.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "bench/growth_report.hpp"
#include "formats/format_testing.hpp"

namespace tureen::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(GrowthSection, WithoutAFitItSaysSoAndHasNoTableOfFits) {
  Growth growth{.commit = "abc1234",
                .cpu = "a CPU",
                .context = "EGL",
                .renderer = "llvmpipe",
                .software = true};
  for (const double elongation : {1.0, 4.0}) {
    GrowthPoint point{.kind = "opaque", .series = "shape", .layers = 4, .width = 64, .height = 36};
    point.sample = {.triangles = 1000, .fragments = 5000, .shaded_pixels = 1250, .ms = 2};
    point.round_ms = {2, 3, 2};
    point.spread = 0.5;
    point.unsettled_rounds = 1;
    point.elongation = elongation;
    growth.points.push_back(point);
  }
  fit(growth);
  const tureen::testing::TemporaryFolder folder;
  write_growth(growth, folder / "");
  std::filesystem::create_directories(folder / "growth");
  std::filesystem::rename(folder / "growth.json", folder / "growth/growth.json");
  std::ofstream(folder / "growth/growth-fit.svg") << "<svg/>";  // of an earlier run
  std::ofstream(folder / "growth.run.json")
      << R"({"command": "c", "date": "2026-01-02T03:04:05Z", "commit": "a", "cpu": "b", "cores": 2})";
  std::ofstream printed(folder / "growth.txt");
  for (const std::string& line : explanation(growth)) printed << line << "\n";
  printed.close();

  const Section section = growth_section({folder / "", {"growth"}}, "growth");
  EXPECT_THAT(section.text,
              HasSubstr("\n- opaque: the measurements do not tell the costs apart\n"));
  EXPECT_THAT(section.text, HasSubstr("\n- opaque: in cells as long as high"));
  EXPECT_THAT(section.text, AllOf(HasSubstr("| width / height of a cell | 1 | 4 |\n"),
                                  HasSubstr("| opaque | 2.00 | 2.00 |\n"),
                                  HasSubstr("spreads of the rounds 50.0 % to 50.0 %; 3 rounds, "
                                            "2 of all begun before a point was stable.")));
  EXPECT_THAT(section.text, Not(HasSubstr("standard errors")));
  EXPECT_TRUE(section.plots.empty());
}

}  // namespace
}  // namespace tureen::test
