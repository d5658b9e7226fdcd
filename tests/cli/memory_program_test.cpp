// Program tests of --max-memory: every command that reads scenes or datasets applies it.
#include <gmock/gmock.h>

#include "tests/cli/program_fixture.hpp"
#include "tests/formats/dataset/dataset_fixture.hpp"
#include "tests/support/errors.hpp"

namespace tureen {
namespace memory_program_test {

using test::ChildResult;
using test::Names;
using test::Program;

class MaxMemory : public Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    write_scene();
    test::write_image(folder / "photographs/a.png", test::an_image(64, 48));
    const std::string frame = R"({"file_path": "a.png",
      "transform_matrix": [[1,0,0,0],[0,1,0,0],[0,0,1,2],[0,0,0,1]]})";
    write("photographs/transforms.json",
          R"({"camera_angle_x": 0.7, "frames": [)" + frame + "," + frame + "]}");
  }
  std::vector<std::vector<std::string>> readers() const {
    return {{"render", "scene.off"},
            {"info", "scene.off"},
            {"convert", "scene.off", "out.glb"},
            {"eval", "scene.off", "photographs"},
            {"bench", "scene.off"},
            {"tradeoff", "scene.off"},
            {"train", "photographs", "-o", "out.glb"},
            {"compare", "photographs/a.png", "photographs/a.png"}};
  }
};

TEST_F(MaxMemory, IsObeyedByEveryCommandThatReads) {
  for (std::vector<std::string> arguments : readers()) {
    SCOPED_TRACE(arguments[0]);
    arguments.insert(arguments.end(), {"--max-memory", "30"});
    const ChildResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_THAT(result.err, Names("30 bytes", "--max-memory"));
    EXPECT_FALSE(exists("out.glb"));
    EXPECT_FALSE(exists("out.png"));
  }
  EXPECT_EQ(run({"info", "scene.off", "--max-memory", "100kB"}).exit_code, 0);
}

TEST_F(MaxMemory, IsInTheHelpAndRefusedWhereItIsNone) {
  for (const std::vector<std::string>& arguments : readers()) {
    EXPECT_THAT(run({arguments[0], "--help"}).out, Names("--max-memory"));
    const ChildResult result = run({arguments[0], arguments[1], "--max-memory", "much"});
    EXPECT_EQ(result.exit_code, 2) << arguments[0];
    EXPECT_THAT(result.err, Names("much", "512MiB", "8GiB"));
  }
}

TEST_F(MaxMemory, IsTheWindowsToo) {
  const ChildResult help = run({"view", "--help"});
  if (help.exit_code != 0) GTEST_SKIP() << "built without the window: " << help.err;
  EXPECT_THAT(help.out, Names("--max-memory"));
  const ChildResult result = run({"view", "--max-memory", "much"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, Names("much"));
}

TEST_F(MaxMemory, NamesThatAreNotUtf8AreSaidInJson) {
  const std::string odd = "\xff\xfe.off";
  std::filesystem::copy(folder / "scene.off", folder / odd);
  const ChildResult result = run({"info", odd, "--json"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_FALSE(nlohmann::json::parse(result.out)["triangles"].is_null());
}

}  // namespace memory_program_test
}  // namespace tureen
