// `tureen plot` from outside.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli/program_fixture.hpp"

namespace tureen {
namespace {

using test::ChildResult;
using testing::HasSubstr;

class Plot : public test::Program {
 protected:
  static std::string line(int step, double psnr) {
    const nlohmann::json record{
        {"step", step},        {"seconds", step / 10.0}, {"loss", 1.0 / step},   {"l1", 0.1},
        {"ssim", 0.8},         {"train_psnr_db", psnr},  {"test_psnr_db", psnr}, {"triangles", 100},
        {"it_per_second", 10}, {"non_finite", 0}};
    return record.dump() + "\n";
  }
};

TEST_F(Plot, DrawsLogsAndTellsTheirEnds) {
  write("a.jsonl", line(100, 20) + line(200, 21.5));
  write("b.jsonl", line(100, 22));
  const ChildResult result = run({"plot", "a.jsonl", "b.jsonl", "--label", "ours", "--label",
                                  "theirs", "-o", "both.svg", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["output"], nlohmann::json({"both.svg"}));
  EXPECT_EQ(json["runs"][0]["name"], "ours");
  EXPECT_EQ(json["runs"][0]["steps"], 200);
  EXPECT_EQ(json["runs"][0]["test_psnr_db"], 21.5);
  EXPECT_EQ(json["runs"][1]["records"], 1);
  std::ifstream file(folder / "both.svg");
  const std::string svg{std::istreambuf_iterator<char>(file), {}};
  EXPECT_THAT(svg, HasSubstr(">theirs</text>"));
}

TEST_F(Plot, NamesLogsByTheirFilesOrFolders) {
  write("a.jsonl", line(100, 20));
  for (const char* name : {"one", "two"}) {
    std::filesystem::create_directories(folder / name);
    write(std::string(name) + "/log.jsonl", line(100, 20));
  }
  EXPECT_THAT(run({"plot", "a.jsonl", "one/log.jsonl"}).err, HasSubstr("a: 100 steps in 10 s"));
  EXPECT_THAT(run({"plot", "one/log.jsonl", "two/log.jsonl"}).err, HasSubstr("two: 100 steps"));
  EXPECT_TRUE(exists("training.svg"));
}

TEST_F(Plot, RefusesWhatItCannotDraw) {
  write("a.jsonl", line(100, 20));
  write("empty.jsonl", "");
  write("bad.jsonl", line(100, 20) + "{}\n");
  const auto expect = [&](const std::vector<std::string>& arguments, int code,
                          const std::string& words) {
    const ChildResult result = run(arguments);
    EXPECT_EQ(result.exit_code, code);
    EXPECT_THAT(result.err, HasSubstr(words));
    EXPECT_FALSE(exists("training.svg"));
  };
  expect({"plot"}, 2, "LOG is required");
  expect({"plot", "a.jsonl", "-o", "a.png"}, 2, "plots are written as SVG");
  expect({"plot", "a.jsonl", "--label", "x", "--label", "y"}, 2, "2 labels for 1 logs");
  expect({"plot", "aa.jsonl"}, 3, "did you mean a.jsonl?");
  expect({"plot", "empty.jsonl"}, 3, "it holds no record yet");
  expect({"plot", "bad.jsonl"}, 3, "bad.jsonl:2: no record of training: lacks \"step\"");
  expect({"plot", "a.jsonl", "-o", "nowhere/a.svg"}, 5, "nowhere/a.svg");
}

}  // namespace
}  // namespace tureen
