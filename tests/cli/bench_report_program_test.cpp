// Program tests of the files of `tureen bench`, and of its exit code after a slowdown.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/program_fixture.hpp"
#include "tests/support/errors.hpp"

namespace tureen {
namespace bench_report_program_test {

using test::ChildResult;
using test::Names;

class BenchFiles : public test::Program {
 protected:
  ChildResult bench(std::vector<std::string> more) const {
    std::vector<std::string> arguments{"bench",  "scene.off", "--context", "osmesa",
                                       "--size", "32x18",     "--rounds",  "3",
                                       "--only", "tureen",    "--cameras", "orbit:2"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  nlohmann::json read_json(const std::string& name) const {
    std::ifstream stream(folder / name);
    return nlohmann::json::parse(stream);
  }
};

TEST_F(BenchFiles, ARunIsComparedWithAnEarlierOne) {
  write_scene();
  const ChildResult first = bench({"-o", "before"});
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_TRUE(exists("before/bench.json"));
  EXPECT_TRUE(exists("before/report.html"));
  // The earlier run becomes much faster, so that the machine's load does not decide the test.
  nlohmann::json before = read_json("before/bench.json");
  for (auto& measurement : before["measurements"]) {
    measurement["frame_ms"]["min_of_medians"] =
        measurement["frame_ms"]["min_of_medians"].get<double>() / 1e3;
    measurement["frame_ms"]["spread"] = 0;
    measurement["aa_spread"] = 0;
  }
  before["machine"]["cpu"] = "an abacus";
  write("fast.json", before.dump());
  const ChildResult told = bench({"--against", "fast.json", "--json"});
  EXPECT_EQ(told.exit_code, 0) << "it fails only with --fail-slower";
  const auto json = nlohmann::json::parse(told.out);
  EXPECT_EQ(json["comparison"]["against"], "fast.json");
  for (const auto& ratio : json["comparison"]["ratios"]) {
    EXPECT_EQ(ratio["verdict"], "slower");
    EXPECT_EQ(ratio["same_pixels"], true);
    EXPECT_GT(ratio["ratio"], 100);
  }
  EXPECT_EQ(json["comparison"]["ratios"].size(), before["measurements"].size());
  EXPECT_THAT(told.err, Names("an abacus"));
  const ChildResult failed = bench({"--against", "fast.json", "--fail-slower", "50"});
  EXPECT_EQ(failed.exit_code, 1) << failed.err;
}

TEST_F(BenchFiles, BadArgumentsAreSaidBeforeAnythingIsMeasured) {
  write_scene();
  EXPECT_EQ(bench({"--fail-slower", "5"}).exit_code, 2);
  const ChildResult missing = bench({"--against", "none.json"});
  EXPECT_EQ(missing.exit_code, 3);
  EXPECT_THAT(missing.err, Names("none.json"));
  write("other.json", "{\"format\": \"tureen growth\"}");
  const ChildResult other = bench({"--against", "other.json", "-o", "out"});
  EXPECT_EQ(other.exit_code, 3);
  EXPECT_THAT(other.err, Names("other.json", "tureen bench"));
  EXPECT_FALSE(exists("out"));
}

}  // namespace bench_report_program_test
}  // namespace tureen
