// Checkpoints of triangle windows through the program: read, converted, drawn soft and opaque.
#include <gmock/gmock.h>

#include <algorithm>

#include "tests/cli/program_fixture.hpp"

namespace tureen {
namespace checkpoint_program_test {

using testing::HasSubstr;

class Checkpoints : public test::Program, public testing::WithParamInterface<const char*> {
 protected:
  /// Draws the scene. Returns what the program reports.
  std::string render(std::vector<std::string> arguments, const std::string& image) const {
    arguments.insert(arguments.begin(), "render");
    for (const char* option : {"-o", image.c_str(), "--size", "80x60"})
      arguments.emplace_back(option);
    const test::ChildResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.err;
  }
};

TEST_P(Checkpoints, AreDrawnLikeTheirGlb) {
  const std::string name = GetParam();
  const std::string checkpoint = TUREEN_SOURCE_DIR "/tests/formats/data/" + name + ".pt";
  ASSERT_EQ(run({"convert", checkpoint, "scene.glb"}).exit_code, 0);
  const auto result = run({"info", "--json", "scene.glb"});
  const auto json = nlohmann::ordered_json::parse(result.out);
  EXPECT_EQ(json["kernel"], "triangle windows");
  EXPECT_EQ(json["per_corner"], name != "triangle_splatting");
  EXPECT_EQ(json["profile"], name == "mesh_splatting" ? "mesh-splatting" : "triangle-splatting");

  render({checkpoint}, "soft.png");
  render({"scene.glb"}, "glb.png");
  const Image8 soft = read_png("soft.png");
  const auto background = std::count(soft.pixels.begin(), soft.pixels.end(), soft.pixels.front());
  EXPECT_LT(std::size_t(background), soft.pixels.size() - 20);
  EXPECT_EQ(read_png("glb.png").pixels, soft.pixels);

  EXPECT_THAT(render({checkpoint, "--opaque"}, "opaque.png"), HasSubstr("drawn opaque"));
  EXPECT_NE(read_png("opaque.png").pixels, soft.pixels);
}

INSTANTIATE_TEST_SUITE_P(, Checkpoints,
                         testing::Values("triangle_splatting", "triangle_splatting_plus",
                                         "mesh_splatting"),
                         [](const auto& each) { return std::string(each.param); });

}  // namespace checkpoint_program_test
}  // namespace tureen
