// `tureen cameras` and `tureen train` on photographs without cameras, with a stand-in for COLMAP.
#include <gmock/gmock.h>

#include <csignal>
#include <cstdlib>

#include "base/platform/process.hpp"
#include "tests/cli/program_fixture.hpp"

namespace tureen::test {
namespace cameras_program_test {

constexpr const char* stand_in = TUREEN_SOURCE_DIR "/tests/jobs/cameras/colmap_stand_in.py";

class Photographs : public Program {
 protected:
  void SetUp() override {
    if (!is_on_path("python3")) GTEST_SKIP() << "the stand-in for COLMAP needs python3";
    Program::SetUp();
    std::filesystem::create_directories(folder / "my photos");
    for (int i = 0; i < 12; ++i)
      write_png("my photos/p" + std::to_string(i) + ".png",
                Image8(64, 48, glm::u8vec4(20 * i, 100, 100, 255)));
    setenv("STAND_IN_LOG", (folder / "calls").c_str(), 1);
    setenv("STAND_IN", "", 1);
  }
  std::vector<std::string> with_stand_in(std::vector<std::string> arguments) const {
    arguments.insert(arguments.end(), {"--colmap", stand_in});
    return arguments;
  }
};

TEST_F(Photographs, BecomeADatasetWithAPlot) {
  const ChildResult result = run(with_stand_in({"cameras", "my photos", "--json"}));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::ordered_json::parse(result.out);
  EXPECT_EQ(json.at("registered"), 12);
  EXPECT_EQ(json.at("output"), "my photos.dataset");
  EXPECT_TRUE(exists("my photos.dataset/cameras.svg"));
  EXPECT_EQ(run({"info", "my photos.dataset"}).exit_code, 0);
  EXPECT_EQ(run(with_stand_in({"cameras", "my photos"})).exit_code, 2);  // it exists
}

TEST_F(Photographs, ThatAreRefusedEndWithTheReason) {
  setenv("STAND_IN", "turning", 1);
  const ChildResult result = run(with_stand_in({"cameras", "my photos", "-o", "out"}));
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err, testing::HasSubstr("turned on the spot"));
  EXPECT_FALSE(exists("out"));
}

TEST_F(Photographs, AreTrainedByOneCommandThatContinuesAfterCtrlC) {
  const std::vector<std::string> command =
      with_stand_in({"train", "my photos", "-o", "scene.glb", "--steps", "30", "--scale", "0.5"});
  setenv("STAND_IN", "slow=mapper", 1);
  {
    Child child(command, folder);
    ASSERT_TRUE(child.wait_until(
        [&] { return bytes_of_file(folder / "calls").find("mapper") != std::string::npos; }));
    child.signal(SIGINT);
    const ChildResult result = child.wait();
    EXPECT_EQ(result.exit_code, 5);
  }
  EXPECT_FALSE(exists("scene.dataset"));
  setenv("STAND_IN", "", 1);
  std::filesystem::remove(folder / "calls");
  std::vector<std::string> again = command;
  again.push_back("--resume");  // as after Ctrl-C during training
  const ChildResult result = run(again);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const std::string calls = bytes_of_file(folder / "calls");
  EXPECT_EQ(calls.find("feature_extractor"), std::string::npos) << calls;
  EXPECT_TRUE(exists("scene.glb"));
  EXPECT_THAT(result.err, testing::HasSubstr("tureen cameras 'my photos' -o scene.dataset"));
  EXPECT_THAT(result.err, testing::HasSubstr("--method gaussians"));
  EXPECT_THAT(result.err, testing::Not(testing::HasSubstr("--minutes")));  // --steps replaces it
  // Another run uses the dataset.
  std::filesystem::remove(folder / "calls");
  const ChildResult more = run(with_stand_in(
      {"train", "my photos", "-o", "scene.glb", "--steps", "10", "--method", "diffsoup"}));
  EXPECT_EQ(more.exit_code, 0) << more.err;
  EXPECT_FALSE(exists("calls"));
}

TEST_F(Photographs, InsideADatasetAreNotSearchedAgain) {
  write("transforms.json", "{}");
  const ChildResult result =
      run(with_stand_in({"train", "my photos", "-o", "scene.glb", "--steps", "1"}));
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err,
              testing::HasSubstr("tureen train " + folder.string() + " trains from it"));
  EXPECT_THAT(result.err, testing::HasSubstr("tureen cameras 'my photos' finds cameras"));
  EXPECT_FALSE(exists("calls"));
  EXPECT_FALSE(exists("scene.dataset"));
}

TEST_F(Photographs, ResumeContinuesASearchOnlyIfThereIsOne) {
  const std::vector<std::string> command =
      with_stand_in({"cameras", "my photos", "-o", "out", "--resume"});
  const ChildResult nothing = run(command);
  EXPECT_EQ(nothing.exit_code, 2);
  EXPECT_THAT(nothing.err, testing::HasSubstr("out.work is missing"));
  setenv("STAND_IN", "turning", 1);  // refused: its work stays
  EXPECT_EQ(run(with_stand_in({"cameras", "my photos", "-o", "out"})).exit_code, 3);
  EXPECT_EQ(run(command).exit_code, 3);
  EXPECT_FALSE(exists("out"));
}

}  // namespace cameras_program_test
}  // namespace tureen::test
