#include "bench/growth_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/gnuplot.hpp"
#include "formats/format_testing.hpp"
#include "support/markup.hpp"
#include "support/schema.hpp"

namespace tureen::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using tureen::testing::TemporaryFolder;

/// Times made by a model, but for one point that is 1.5 times as long.
Growth growth() {
  Growth result{.commit = "abc",
                .cpu = "a <cpu>",
                .context = "EGL",
                .renderer = "llvm & pipe",
                .software = true};
  for (const char* kind : {"opaque", "cut-out"})
    for (const char* series : {"triangles", "pixels", "overdraw"})
      for (int i = 1; i <= 8; ++i) {
        const bool triangles = series[0] == 't', pixels = series[0] == 'p';
        GrowthPoint point{.kind = kind,
                          .series = series,
                          .layers = triangles || pixels ? 4 : i,
                          .width = pixels ? 160 * i : 1280,
                          .height = pixels ? 90 * i : 720};
        point.sample.triangles = triangles ? 1000 << i : 65536;
        point.sample.shaded_pixels = 0.64 * point.width * point.height;
        point.sample.fragments = point.sample.shaded_pixels * point.layers;
        point.sample.ms = 0.5 + 2e-5 * point.sample.triangles + 3e-6 * point.sample.fragments +
                          4e-5 * point.sample.shaded_pixels;
        point.p95_ms = 1.1 * point.sample.ms;
        result.points.push_back(point);
      }
  result.points.back().sample.ms *= 1.5;
  fit(result);
  return result;
}

std::string contents(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

TEST(GrowthReport, SaysTheCostsAndWhatTheModelMisses) {
  const std::vector<std::string> lines = explanation(growth());
  ASSERT_EQ(lines.size(), 4u);
  EXPECT_THAT(lines[0], HasSubstr("opaque: a frame costs 0.5 "));
  EXPECT_THAT(lines[0], HasSubstr("a triangle 20 "));
  EXPECT_THAT(lines[0], HasSubstr("a fragment 3 "));
  EXPECT_THAT(lines[0], HasSubstr("a shaded pixel 40 "));
  EXPECT_THAT(lines[1], HasSubstr("0 % at most."));
  EXPECT_THAT(lines[3], HasSubstr("by more than 20 % at: overdraw (65,536 triangles, 1280x720, 8"));
}

TEST(GrowthReport, WritesWhatItPromises) {
  const TemporaryFolder folder;
  write_growth(growth(), folder / "");
  const auto json = nlohmann::json::parse(contents(folder / "growth.json"));
  EXPECT_EQ(schema_violations(json, "growth.schema.json"), "");
  EXPECT_EQ(json["fits"].size(), 2u);
  EXPECT_EQ(json["points"].size(), 48u);
  const std::string html = contents(folder / "growth.html");
  const Markup markup = check_markup(html);
  EXPECT_EQ(markup.defect, "");
  EXPECT_THAT(html, HasSubstr("a &lt;cpu&gt;"));
  if (!cli::draw_plot({.title = "a", .script = "plot 1"}, cli::PlotFormat::svg))
    GTEST_SKIP() << cli::gnuplot_missing;
  EXPECT_THAT(markup.elements, Contains("svg"));
  for (const char* name :
       {"growth-triangles.svg", "growth-pixels.svg", "growth-overdraw.svg", "growth-fit.svg"})
    EXPECT_EQ(check_markup(contents(folder / name)).defect, "") << name;
  // 26 to 66 ms, between two powers of ten, the only ticks that gnuplot would have.
  EXPECT_THAT(contents(folder / "growth-overdraw.svg"), HasSubstr(">50</text>"));
}

TEST(GrowthReport, WithoutAFitItSaysSo) {
  Growth few = growth();
  few.points.resize(3);
  few.fits.clear();
  fit(few);
  EXPECT_THAT(explanation(few), Contains(HasSubstr("do not tell the costs apart")));
  const TemporaryFolder folder;
  write_growth(few, folder / "");
  EXPECT_EQ(check_markup(contents(folder / "growth.html")).defect, "");
  EXPECT_EQ(schema_violations(nlohmann::json::parse(contents(folder / "growth.json")),
                              "growth.schema.json"),
            "");
}

}  // namespace
}  // namespace tureen::test
