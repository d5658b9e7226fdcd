#include "cli/options/arguments.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/support/errors.hpp"

namespace tureen::cli {
namespace arguments_test {

using test::ErrorAt;
using testing::ElementsAre;

/// A program with a command `draw` that has every kind of option.
struct Program {
  Program() {
    Command program = line.program();
    program.add_text_flag(
        "--version", [] { return "1"; }, "");
    Command draw = program.add_command("draw", "");
    draw.add_option("SCENE", scene, "the scene").required();
    draw.add_option("-o,--output FILE", output, "");
    draw.add_option("--lines", lines, "");
    draw.add_option("--cases", cases, "").comma_list();
    const Option width = draw.add_option("--width", width_, "", between(1, 100));
    draw.add_option("--steps", steps, "");
    draw.add_option("--seed", seed, "");
    draw.add_option("--frames", frames, "").needs(width);
    const Option any = draw.add_option("--any", any_, "");
    draw.add_option("--scale", scale, "", between(0.25, 1.0)).excludes(any);
    draw.add_option(
        "--log", [this](const std::string& text) { log.push_back(text); }, "");
    draw.add_option(
        "--logs", [this](const std::vector<std::string>& texts) { log = texts; }, "");
    draw.add_flag("--fast", fast, "");
    draw.add_flag(
        "--loud", [this] { log.emplace_back("loud"); }, "");
    add_choice<int>(draw, "--side", side, {{"front", 1}, {"back", 2}}, "");
    draw.does([] { return ExitCode::check_failed; });
    program.add_command("pass", "").does_with_rest([this](const auto& arguments) {
      rest = arguments;
      return ExitCode::done;
    });
  }

  std::optional<test::Refusal> refusal(std::vector<std::string> arguments) {
    return test::error_of<UsageError>([&] { line.parse(std::move(arguments)); });
  }

  CommandLine line{"program", "It draws."};
  std::string scene, output = "out";
  std::vector<std::string> lines, cases, log, rest;
  int width_ = 5, side = 0;
  std::optional<std::int64_t> steps;
  std::optional<std::uint64_t> seed;
  std::optional<int> frames;
  double any_ = 0.5;
  std::optional<double> scale;
  bool fast = false;
};

TEST(Arguments, ValuesAreStoredAndTheCommandReturned) {
  Program program;
  const Action action = program.line.parse(
      {"draw", "a.glb", "--steps", "-3", "--seed=18446744073709551615", "--width", "7", "--frames",
       "2", "--any", "1e-3", "--cases", "a,b", "--log", "x", "--fast", "--side", "back"});
  EXPECT_EQ(action(), ExitCode::check_failed);
  EXPECT_EQ(program.line.chosen_command(), "draw");
  EXPECT_EQ(program.scene, "a.glb");
  EXPECT_EQ(program.output, "out");  // the default
  EXPECT_EQ(program.steps, -3);
  EXPECT_EQ(program.seed, std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(program.width_, 7);
  EXPECT_EQ(program.frames, 2);
  EXPECT_EQ(program.any_, 1e-3);
  EXPECT_EQ(program.scale, std::nullopt);
  EXPECT_THAT(program.cases, ElementsAre("a", "b"));
  EXPECT_THAT(program.log, ElementsAre("x"));
  EXPECT_TRUE(program.fast);
  EXPECT_EQ(program.side, 2);
}

TEST(Arguments, AListTakesAllThatFollowUnlessItIsASingleArgument) {
  Program program;
  program.line.parse({"draw", "--lines", "a", "b,c", "--cases", "d,e", "a.glb"});
  EXPECT_THAT(program.lines, ElementsAre("a", "b,c"));
  EXPECT_THAT(program.cases, ElementsAre("d", "e"));
  EXPECT_EQ(program.scene, "a.glb");
}

TEST(Arguments, ACheckComesBeforeTheValueIsStored) {
  Program program;
  for (const char* width : {"0", "101", "0x10", "2.5", "nan", ""})
    EXPECT_THAT(program.refusal({"draw", "a.glb", "--width", width}),
                ErrorAt("", "--width", width, 1, 100));
  EXPECT_EQ(program.width_, 5);
  for (const char* scale : {"0.2", "1.1", "nan", "inf"})
    EXPECT_THAT(program.refusal({"draw", "a.glb", "--scale", scale}),
                ErrorAt("", "--scale", scale, 0.25));
  EXPECT_EQ(program.scale, std::nullopt);
}

TEST(Arguments, NumbersAreFiniteWithoutACheckToo) {
  Program program;
  for (const char* number : {"nan", "-nan", "nan(7)", "inf", "-inf", "many"})
    EXPECT_THAT(program.refusal({"draw", "a.glb", "--any", number}), ErrorAt("", "--any"));
  EXPECT_EQ(program.any_, 0.5);
}

TEST(Arguments, RequirementsNeedsAndExclusions) {
  Program program;
  EXPECT_THAT(program.refusal({"draw"}), ErrorAt("", "SCENE"));
  EXPECT_THAT(program.refusal({"draw", "a.glb", "--frames", "3"}),
              ErrorAt("", "--frames", "--width"));
  EXPECT_THAT(program.refusal({"draw", "a.glb", "--scale", "1", "--any", "1"}),
              ErrorAt("", "--scale", "--any"));
  EXPECT_THAT(program.refusal({"draw", "a.glb", "b.glb"}), ErrorAt("", "b.glb"));
  EXPECT_THAT(program.refusal({"draw", "a.glb", "--output", ""}), ErrorAt("", "--output"));
  EXPECT_THAT(program.refusal({"draw", "a.glb", "--width", "1", "--width", "2"}),
              ErrorAt("", "--width"));
  EXPECT_THAT(program.refusal({}), ErrorAt(""));
}

TEST(Arguments, UnknownNamesAreRefusedWithTheNearest) {
  Program program;
  EXPECT_THAT(program.refusal({"drw"}), ErrorAt("", "drw", "draw"));
  EXPECT_EQ(program.line.chosen_command(), "");
  EXPECT_THAT(program.refusal({"draw", "a.glb", "--widht=3"}), ErrorAt("", "--widht", "--width"));
  EXPECT_EQ(program.line.chosen_command(), "draw");
  EXPECT_THAT(program.refusal({"draw", "a.glb", "--side", "bck"}),
              ErrorAt("", "--side", "bck", "front", "back"));
}

TEST(Arguments, HelpAndTextsArePrintedInsteadOfTheCommand) {
  Program program;
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"draw", "--help"}, {"--version"}}) {
    testing::internal::CaptureStdout();
    EXPECT_EQ(program.line.parse(arguments)(), ExitCode::done);
    const std::string text = testing::internal::GetCapturedStdout();
    if (arguments.front() == "draw")
      EXPECT_THAT(text, test::Names("SCENE", "--output FILE", "the scene"));
    else
      EXPECT_EQ(text, "1\n");
  }
  EXPECT_THAT(program.line.help(), test::Names("draw", "--version"));
}

TEST(Arguments, ACommandMayTakeWhateverFollows) {
  Program program;
  EXPECT_EQ(program.line.parse({"pass", "a", "--help", "--width=x"})(), ExitCode::done);
  EXPECT_THAT(program.rest, ElementsAre("a", "--help", "--width=x"));
}

}  // namespace arguments_test
}  // namespace tureen::cli
