// `tureen bench --import` from outside: what it says, and the files it leaves.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli/program_fixture.hpp"

namespace tureen {
namespace {

using test::ChildResult;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class BenchImport : public test::Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    std::ifstream stream(std::string(TUREEN_SOURCE_DIR) + "/tests/cli/web_bench.json");
    phone = nlohmann::json::parse(stream);
    write("phone.json", phone.dump());
    nlohmann::json laptop = phone;
    laptop["device"]["renderer"] = "llvmpipe";
    laptop["device"]["software"] = true;
    write("laptop.json", laptop.dump());
  }
  std::string text_of(const std::string& name) const {
    std::ifstream stream(folder / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  nlohmann::json phone;
};

TEST_F(BenchImport, OneDeviceIsToldAsARunIs) {
  const ChildResult result = run({"bench", "--import", "phone.json", "-o", "out", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_THAT(result.err, HasSubstr("Adreno (TM) 740 (WebGL2"));
  EXPECT_THAT(result.err, HasSubstr("1280 x 720, hemisphere:3: 3 views, 3 rounds of 4 frames"));
  EXPECT_EQ(nlohmann::json::parse(text_of("out/bench.json")), json);
  for (const char* name : {"out/bench.csv", "out/bench.md", "out/bench.html"})
    EXPECT_THAT(text_of(name), HasSubstr("Adreno")) << name;
  // Against itself nothing has changed.
  std::vector<std::string> again{"bench", "--import", "phone.json", "--against", "out/bench.json"};
  const ChildResult compared = run(again);
  EXPECT_EQ(compared.exit_code, 0) << compared.err;
  EXPECT_THAT(compared.err, HasSubstr("equal"));
  // One size has a single round there, of which no difference could be told.
  again.insert(again.end(), {"--fail-slower", "0"});
  const ChildResult refused = run(again);
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("--fail-slower wants 3 rounds of out/bench.json, too"));
}

TEST_F(BenchImport, SeveralDevicesStandSideBySide) {
  const ChildResult result = run({"bench", "--import", "phone.json", "--import", "laptop.json",
                                  "-o", "out", "--csv", "all.csv", "--plots", "plots", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  ASSERT_EQ(json.size(), 2u);
  EXPECT_EQ(json[1]["device"]["renderer"], "llvmpipe");
  EXPECT_THAT(result.err, HasSubstr("configuration  phone  laptop"));
  for (const char* name :
       {"out/phone-ficus/bench.html", "out/laptop-ficus/bench.html", "out/laptop-ficus/bench.json"})
    EXPECT_TRUE(exists(name)) << name;
  EXPECT_THAT(text_of("out/devices.md"), HasSubstr("| tureen | 3.000 | 3.000 |"));
  EXPECT_THAT(text_of("out/devices.html"), HasSubstr("llvmpipe (software)"));
  EXPECT_EQ(text_of("all.csv"), text_of("out/bench.csv"));
  const std::string csv = text_of("all.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 2 * 3);
  EXPECT_TRUE(exists("plots/phone-ficus"));
  EXPECT_EQ(run({"bench", "--import", "phone.json", "--import", "laptop.json", "--against",
                 "out/phone-ficus/bench.json"})
                .exit_code,
            2);
}

TEST_F(BenchImport, WrongUsageAndBadFilesLeaveNothing) {
  write_scene();
  const auto expect = [&](int exit_code, std::vector<std::string> arguments,
                          const std::string& words) {
    arguments.insert(arguments.begin(), "bench");
    arguments.insert(arguments.end(), {"-o", "out"});
    const ChildResult result = run(arguments);
    EXPECT_EQ(result.exit_code, exit_code);
    EXPECT_THAT(result.err, HasSubstr(words));
    EXPECT_THAT(result.out, IsEmpty());
    EXPECT_FALSE(exists("out"));
  };
  expect(2, {}, "SCENE is required, or --import");
  expect(2, {"--import", "phone.json", "--rounds", "3"},
         "--rounds means nothing with --import: nothing is measured");
  expect(2, {"scene.off", "--import", "phone.json"}, "SCENE means nothing with --import");
  expect(2, {"--import", "phone.json", "--csv", "phone.json"}, "phone.json is an input itself");
  expect(3, {"--import", "phon.json"}, "did you mean phone.json?");
  phone["scenes"][0]["measurements"][0]["entrants"][0]["frame_ms"][0][0] = -1;
  write("bad.json", phone.dump());
  expect(3, {"--import", "phone.json", "--import", "bad.json"},
         "bad.json: scenes[0].measurements[0].entrants[0].frame_ms[0][0]: -1 is no time");
  EXPECT_THAT(run({"bench", "--help"}).out, HasSubstr("--import FILE.json"));
}

}  // namespace
}  // namespace tureen
