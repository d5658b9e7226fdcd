// Program tests of scenes with splats: profiles, the authors' culls, lint.
#include <gmock/gmock.h>

#include "formats/scene_file.hpp"
#include "formats/tureen_glb/tureen_glb.hpp"
#include "tests/cli/program_fixture.hpp"
#include "tests/support/random_splats.hpp"

namespace tureen {
namespace splats_program_test {

using test::ChildResult;
using testing::HasSubstr;
using testing::Not;

class SplatsProgram : public test::Program {
 protected:
  void SetUp() override {
    test::Program::SetUp();
    write_scene();
    write_tureen_glb(scene_of(test::random_splats(test::splat_kinds[1], 300, 0.01, 1)),
                     folder / "gaussians.glb");
    write_tureen_glb(scene_of(test::random_splats(test::splat_kinds[0], 300, 0.01, 1)),
                     folder / "windows.glb");
  }
  nlohmann::json json_of(const std::vector<std::string>& arguments) const {
    const ChildResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return nlohmann::json::parse(result.out);
  }
  void expect_usage_error(const std::vector<std::string>& arguments, const std::string& says) {
    const ChildResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_THAT(result.err, HasSubstr(says));
  }
};

TEST_F(SplatsProgram, AChosenProfileIsSaved) {
  for (const char* output : {"mip.glb", "mip.ply"}) {
    ASSERT_EQ(run({"convert", "gaussians.glb", output, "--profile", "mip"}).exit_code, 0);
    EXPECT_EQ(json_of({"info", output, "--json"})["profile"], "mip") << output;
  }
  EXPECT_EQ(json_of({"info", "gaussians.glb", "--json", "--profile", "mip"})["profile"], "mip");
  EXPECT_EQ(json_of({"info", "gaussians.glb", "--json"})["profile"], "3dgs");
}

TEST_F(SplatsProgram, AProfileThatDoesNotFitIsRefused) {
  expect_usage_error({"info", "gaussians.glb", "--profile", "2dsg"}, "did you mean 2dgs?");
  expect_usage_error({"info", "gaussians.glb", "--profile", "2dgs"}, "flat Gaussians");
  expect_usage_error({"info", "scene.off", "--profile", "2dgs"}, "has none");
  // It is for the splats among several scenes.
  EXPECT_EQ(run({"info", "scene.off", "gaussians.glb", "--profile", "mip"}).exit_code, 0);
}

TEST_F(SplatsProgram, ANearLimitThatHidesTheSceneIsReportedAndChanged) {
  Splats splats = test::random_splats(test::splat_kinds[1], 300, 0.01, 1);
  splats.profile.min_center_depth = 1000;
  write_tureen_glb(scene_of(splats), folder / "small.glb");
  EXPECT_THAT(run({"info", "small.glb"}).err, HasSubstr("--near-limit changes it"));
  EXPECT_EQ(run({"info", "small.glb", "--strict"}).exit_code, 1);
  ASSERT_EQ(run({"convert", "small.glb", "mended.glb", "--near-limit", "0.001"}).exit_code, 0);
  EXPECT_EQ(run({"info", "mended.glb", "--strict"}).exit_code, 0);
  expect_usage_error({"info", "scene.off", "--near-limit", "0.1"}, "has none");
}

TEST_F(SplatsProgram, LintIsReported) {
  Splats splats = test::random_splats(test::splat_kinds[1], 300, 0.01, 1);
  auto& gaussians = std::get<Gaussians>(splats.kernel);
  std::fill(gaussians.opacity.begin(), gaussians.opacity.end(), 0.001f);
  gaussians.centers[7] = gaussians.centers[3];
  gaussians.rotations[7] = gaussians.rotations[3];
  gaussians.scales[7] = gaussians.scales[3];
  write_tureen_glb(scene_of(splats), folder / "faint.glb");
  const nlohmann::json lint = json_of({"info", "faint.glb", "--json"})["lint"];
  EXPECT_EQ(lint["clean"], false);
  EXPECT_EQ(lint["transparent_splats"]["count"], 300);
  EXPECT_EQ(lint["duplicate_splats"]["first"], nlohmann::json({7}));
  EXPECT_EQ(lint["needle_splats"]["count"], 0);
  EXPECT_FALSE(lint.contains("unused_vertices"));
  // Readers of PLY reorder splats. Lint names the file's rows.
  ASSERT_EQ(run({"convert", "faint.glb", "faint.ply"}).exit_code, 0);
  const nlohmann::json of_ply = json_of({"info", "faint.ply", "--json"})["lint"];
  EXPECT_EQ(of_ply["transparent_splats"]["first"], nlohmann::json({0, 1, 2, 3, 4}));
  EXPECT_EQ(of_ply["duplicate_splats"]["first"], nlohmann::json({7}));
  EXPECT_THAT(run({"info", "faint.glb"}).err, HasSubstr("none is drawn"));
  EXPECT_EQ(run({"info", "faint.glb", "--strict"}).exit_code, 1);
  EXPECT_EQ(run({"info", "gaussians.glb", "--strict"}).exit_code, 0);
}

TEST_F(SplatsProgram, OptionsWithoutEffectAreReported) {
  const ChildResult result = run(
      {"render", "gaussians.glb", "--size", "8x8", "--context", "osmesa", "--shading", "compute"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.err, HasSubstr("--shading has no effect"));
  EXPECT_THAT(
      run({"render", "scene.off", "--size", "8x8", "--context", "osmesa", "--as-published"}).err,
      HasSubstr("--as-published has no effect"));
  EXPECT_THAT(run({"render", "gaussians.glb", "--size", "8x8", "--context", "osmesa"}).err,
              Not(HasSubstr("no effect")));
}

TEST_F(SplatsProgram, AsPublishedChangesTheImage) {
  const std::vector<std::string> render{"render", "windows.glb", "--size",
                                        "64x48",  "--context",   "osmesa"};
  const auto image = [&](const std::string& name, std::vector<std::string> further) {
    further.insert(further.begin(), render.begin(), render.end());
    further.insert(further.end(), {"-o", name});
    EXPECT_EQ(run(further).exit_code, 0);
    return read_png(name).pixels;
  };
  EXPECT_NE(image("a.png", {}), image("b.png", {"--as-published"}));
}

}  // namespace splats_program_test
}  // namespace tureen
