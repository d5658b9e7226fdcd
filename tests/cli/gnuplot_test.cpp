#include "cli/gnuplot.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>
#include <set>

#include "cli/html_page.hpp"
#include "formats/format_testing.hpp"
#include "formats/png.hpp"
#include "soup/error.hpp"
#include "support/markup.hpp"

namespace tureen::cli {
namespace {

using test::check_markup;
using test::Markup;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using tureen::testing::TemporaryFolder;

/// gnuplot is an optional tool of whoever runs the program; ./dev setup installs it.
bool gnuplot_is_here() {
  return draw_plot({.title = "one", .script = "plot 1"}, PlotFormat::svg).has_value();
}
#define SKIP_WITHOUT_GNUPLOT() \
  if (!gnuplot_is_here()) GTEST_SKIP() << gnuplot_missing

/// Another value of an environment variable while it lives.
class Environment {
 public:
  Environment(const char* name, const std::string& value) : name_(name) {
    if (const char* old = std::getenv(name)) old_ = old;
    setenv(name, value.c_str(), 1);
  }
  ~Environment() { setenv(name_, old_.c_str(), 1); }

 private:
  const char* name_;
  std::string old_;
};

Plot two_lines(const std::string& title) {
  return {.title = title,
          .script = plot_data("one", {{1, 2, 1, 3}, {2, 4, 3, 5}, {}, {4, 1, 0, 2}}) +
                    "set title " + plot_text(title) +
                    "\nplot $one using 1:2:3:4 with yerrorlines title " + plot_text(title) +
                    ", $one using 1:3 with boxes title 'other'"};
}

TEST(Gnuplot, DrawsAnSvgForPages) {
  SKIP_WITHOUT_GNUPLOT();
  const std::string svg = *draw_plot(two_lines("Frame time"), PlotFormat::svg);
  const Markup markup = check_markup(svg);
  EXPECT_EQ(markup.defect, "");
  EXPECT_THAT(svg, StartsWith("<svg class=\"plot\""));
  EXPECT_THAT(svg, HasSubstr("<title>Frame time</title>"));
  EXPECT_THAT(svg, HasSubstr("width=\"960\""));
  EXPECT_THAT(svg, HasSubstr("prefers-color-scheme:dark"));
  EXPECT_THAT(markup.text, HasSubstr("other"));
  // Both colours are there, in the spelling that the rules for dark pages look for.
  EXPECT_THAT(svg, HasSubstr("'#0072b2'"));
  EXPECT_THAT(svg, HasSubstr("'#d55e00'"));
  EXPECT_THAT(svg, ::testing::Not(HasSubstr("rgb(")));
}

TEST(Gnuplot, SeveralDrawingsStandInOnePage) {
  SKIP_WITHOUT_GNUPLOT();
  HtmlPage page("plots");
  for (const char* title : {"Frame time", "Ratios"})
    page.drawing(*draw_plot(two_lines(title), PlotFormat::svg), title);
  const Markup markup = check_markup(page.text());
  EXPECT_EQ(markup.defect, "");
  EXPECT_EQ(std::set<std::string>(markup.identifiers.begin(), markup.identifiers.end()).size(),
            markup.identifiers.size());
  // Links lead within the page and arrive.
  EXPECT_THAT(markup.links, Each(StartsWith("#")));
  for (const std::string& link : markup.links)
    EXPECT_THAT(markup.identifiers, ::testing::Contains(link.substr(1)));
}

TEST(Gnuplot, TextsAreNoCommands) {
  SKIP_WITHOUT_GNUPLOT();
  const TemporaryFolder folder;
  const std::string mark = (folder / "mark").string();
  for (const std::string& text : std::initializer_list<std::string>{
           "`touch " + mark + "`", "'; system 'touch " + mark + "'; '", "\"; !touch " + mark,
           "a\n!touch " + mark, "$(touch " + mark + ")", "\\", "x\\",
           "it's \"quoted\" {/Bold a}_b^c @x", "<b>&amp; \xc3\xa9"}) {
    const std::string svg = *draw_plot(two_lines(text), PlotFormat::svg);
    EXPECT_EQ(check_markup(svg).defect, "") << text;
    EXPECT_FALSE(std::filesystem::exists(mark)) << text;
  }
  EXPECT_THAT(*draw_plot(two_lines("it's {/Bold a}_b"), PlotFormat::svg),
              HasSubstr("<text>it's {/Bold a}_b</text>"));
}

TEST(Gnuplot, DrawsIntoFilesByTheirNames) {
  SKIP_WITHOUT_GNUPLOT();
  const TemporaryFolder folder;
  const std::string awkward = "it's a \"plot\"; `x` $HOME";
  EXPECT_TRUE(write_plot(two_lines("t"), folder / (awkward + ".png")));
  Input input = Input::open(folder / (awkward + ".png"));
  const Image8 image = read_image(input);
  EXPECT_EQ(image.width, 960);
  EXPECT_EQ(image.height, 440);
  EXPECT_TRUE(write_plot(two_lines("t"), folder / (awkward + ".svg")));
  EXPECT_TRUE(std::filesystem::exists(folder / (awkward + ".svg")));
}

TEST(Gnuplot, AScriptThatFailsLeavesNothing) {
  SKIP_WITHOUT_GNUPLOT();
  const TemporaryFolder folder;
  try {
    write_plot({.title = "bad", .script = "plot $nothing using"}, folder / "bad.svg");
    FAIL() << "nothing thrown";
  } catch (const OutputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("gnuplot failed"));
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder / ""));
}

TEST(Gnuplot, WhereItIsMissingThereIsNoPlot) {
  const TemporaryFolder folder;
  const Environment nowhere("PATH", (folder / "").string());
  EXPECT_FALSE(draw_plot(two_lines("t"), PlotFormat::svg));
  EXPECT_FALSE(write_plot(two_lines("t"), folder / "none.svg"));
  EXPECT_TRUE(std::filesystem::is_empty(folder / ""));
}

TEST(Gnuplot, MarksOnlyTheTicksOfAnAxis) {
  EXPECT_EQ(plot_ticks('y', PlotAxis::logarithmic(0.9, 60, 6)),
            "set ytics (\"1\" 1, \"2\" 2, \"5\" 5, \"10\" 10, \"20\" 20, \"50\" 50)\n");
}

TEST(Gnuplot, DataKeepTheirDigits) {
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(plot_data("a_1", {{1.0 / 3, 1e-300}, {}, {infinity, 2}}),
            "$a_1 << END_OF_DATA\n0.3333333333333333 1e-300\n\nNaN 2\nEND_OF_DATA\n");
  EXPECT_EQ(plot_text("it's 5"), "\"it\\047s 5\"");
}

}  // namespace
}  // namespace tureen::cli
