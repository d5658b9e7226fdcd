// `tureen tradeoff --import` from outside: what it says, and the files it leaves.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "cli/program_fixture.hpp"
#include "cli/tradeoff_fixture.hpp"
#include "support/markup.hpp"

namespace tureen {
namespace {

using nlohmann::json;
using test::chair;
using test::ChildResult;
using test::lego;
using testing::AllOf;
using testing::Each;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::StartsWith;

class TradeoffImport : public test::Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    write("lego.json", lego().dump());
    write("chair.json", chair().dump());
  }
  std::string text_of(const std::string& name) const {
    std::ifstream stream(folder / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  void expect(int exit_code, std::vector<std::string> arguments, const std::string& words) const {
    arguments.insert(arguments.begin(), "tradeoff");
    arguments.insert(arguments.end(), {"-o", "out"});
    const ChildResult result = run(arguments);
    EXPECT_EQ(result.exit_code, exit_code) << words;
    EXPECT_THAT(result.err, HasSubstr(words));
    EXPECT_THAT(result.out, IsEmpty());
    EXPECT_FALSE(exists("out"));
  }
  /// What is said of lego.json and another file.
  void expect_bad(const json& other, const std::string& words) const {
    write("bad.json", other.dump());
    expect(3, {"--import", "lego.json", "--import", "bad.json"}, "bad.json: " + words);
  }
};

TEST_F(TradeoffImport, JoinsTheScenesOfTwoRuns) {
  const ChildResult result =
      run({"tradeoff", "--import", "lego.json", "--import", "chair.json", "-o", "out", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto document = json::parse(result.out);
  EXPECT_EQ(json::parse(text_of("out/scenes.json")), document);
  const json& level = document["drawing"]["configurations"][2];
  EXPECT_EQ(level["name"], "lattice level 2");
  constexpr double rounding = 1e-11;  // of some hundred operations on doubles of at most 1000
  EXPECT_NEAR(level["time_ratio"].get<double>(), 0.8, rounding);
  EXPECT_NEAR(level["psnr_db"].get<double>(), 35, rounding);
  EXPECT_EQ(document["drawing"]["front"], (json{2, 0}));
  EXPECT_EQ(document["scenes"][1]["label"], "chair");
  for (const auto& path : document["output"]) EXPECT_TRUE(exists(path)) << path;

  EXPECT_THAT(result.err, HasSubstr("chair: 7,000 triangles, llvmpipe"));
  EXPECT_THAT(result.err, HasSubstr("E_render of drawing knobs over 2 scenes"));
  EXPECT_THAT(result.err, HasSubstr("* lattice level 2"));
  EXPECT_THAT(text_of("out/scenes.csv"), AllOf(HasSubstr("\ndrawing,lattice level 2,tureen,0."),
                                               HasSubstr(",0.8,8,40,0.0001,0.8,32,30,0.0001\n")));
  const std::string page = text_of("out/scenes.html");
  const test::Markup markup = test::check_markup(page);
  EXPECT_EQ(markup.defect, "");
  EXPECT_THAT(markup.links, Each(StartsWith("#")));
  EXPECT_THAT(std::set(markup.identifiers.begin(), markup.identifiers.end()),
              SizeIs(markup.identifiers.size()));
  EXPECT_THAT(markup.text, HasSubstr("lattice level 2"));
  if (exists("out/means-drawing.svg")) {
    EXPECT_TRUE(exists("out/means-antialiasing.png"));
    EXPECT_TRUE(exists("out/2-drawing.png"));
  } else {
    EXPECT_THAT(result.err, HasSubstr("gnuplot is not installed"));
  }
}

TEST_F(TradeoffImport, SaysWhatItLeavesOut) {
  json other = chair();
  other["drawing"]["configurations"].erase(3);
  write("chair.json", other.dump());
  const ChildResult result = run({"tradeoff", "--import", "lego.json", "--import", "chair.json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, IsEmpty());
  EXPECT_THAT(result.err, HasSubstr("not in chair: shaded once a fragment"));
}

TEST_F(TradeoffImport, DoesNotOverwriteWhatItReads) {
  ASSERT_TRUE(std::filesystem::create_directory(folder / "both"));
  write("both/tradeoff.json", lego().dump());
  const std::string before = text_of("both/tradeoff.json");
  const ChildResult result =
      run({"tradeoff", "--import", "both/tradeoff.json", "--import", "chair.json", "-o", "both"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(text_of("both/tradeoff.json"), before);
}

TEST_F(TradeoffImport, WrongUsage) {
  write_scene();
  expect(2, {}, "SCENE is required, or --import");
  expect(2, {"--import", "lego.json"}, "--import wants two results or more");
  const auto expect_two = [&](std::vector<std::string> more, const std::string& words) {
    more.insert(more.end(), {"--import", "lego.json", "--import", "chair.json"});
    expect(2, more, words + " means nothing with --import: nothing is measured");
  };
  expect_two({"scene.off"}, "SCENE");
  expect_two({"--quick"}, "--quick");
  expect_two({"--rounds", "3"}, "--rounds");
  expect_two({"--least-psnr", "40"}, "--least-psnr");
  expect_two({"--write-preset", "fast.glb"}, "--write-preset");
  expect_two({"--context", "osmesa"}, "--context");
  EXPECT_THAT(run({"tradeoff", "--help"}).out, HasSubstr("--import FILE.json"));
}

TEST_F(TradeoffImport, BadFilesAreNamedWithThePlaceAndTheReason) {
  expect(3, {"--import", "lego.json", "--import", "chai.json"}, "did you mean chair.json?");
  expect(3, {"--import", "lego.json", "--import", "lego.json"}, "a scene counts once");
  write("bad.json", chair().dump().substr(0, 1000));
  expect(3, {"--import", "lego.json", "--import", "bad.json"}, "bad.json: byte ");

  json bad = chair();
  bad["version"] = 2;
  expect_bad(bad, "version: version 2 is newer than this program");
  bad = chair();
  bad["drawing"].erase("aa_spread");
  expect_bad(bad, "drawing: lacks \"aa_spread\"");
  bad = chair();
  bad["drawing"]["configurations"][2]["ms"] = nullptr;
  expect_bad(bad, "drawing.configurations[2].ms: expected a number");
  bad = chair();
  bad["drawing"]["configurations"][2]["e_render"]["view_psnr_db"] = {30, 30};
  expect_bad(bad, "drawing.configurations[2].e_render.view_psnr_db: has 2 elements");
  bad = chair();
  bad["drawing"]["configurations"][2]["knobs"]["site"] = "sideways";
  expect_bad(bad, "drawing.configurations[2].knobs.site: is no setting of the knob site");
  bad = chair();
  bad["protocol"]["samples"] = "exact";
  expect_bad(bad, "protocol.samples: \"exact\", and \"device\" in lego.json");
  // Reading counts what it takes.
  expect(3, {"--import", "lego.json", "--import", "chair.json", "--max-memory", "10kB"},
         "lego.json: ");
  // What --import itself writes is no result of one scene.
  ASSERT_EQ(
      run({"tradeoff", "--import", "lego.json", "--import", "chair.json", "-o", "both"}).exit_code,
      0);
  expect(3, {"--import", "lego.json", "--import", "both/scenes.json"},
         "both/scenes.json: this is no result of tureen tradeoff");
}

}  // namespace
}  // namespace tureen
