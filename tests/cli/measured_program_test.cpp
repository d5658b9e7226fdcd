// `tureen render --depth, --median-depth, --normals, --alpha`.
#include <cmath>
#include <cstring>

#include "tests/cli/program_fixture.hpp"

namespace tureen::test {

class MeasuredProgram : public Program {
 protected:
  /// The plane y = 0 of two triangles, seen from a distance of 4.
  ChildResult measured(std::vector<std::string> further) const {
    write_scene();
    std::vector<std::string> arguments = {"render", "scene.off", "--eye", "0,-4,0", "--target",
                                          "0,0,0",  "--up",      "0,0,1", "--fov",  "60",
                                          "--size", "33x33",     "--json"};
    arguments.insert(arguments.end(), further.begin(), further.end());
    return run(arguments);
  }
  /// The last channel of a row of an EXR of one channel.
  std::vector<float> exr_row(const std::string& name, int row) const {
    Input input = Input::open(folder / name);
    const std::vector<std::byte> bytes = input.read_rest();
    std::vector<float> values(33);
    const std::size_t block = 8 + 33 * sizeof(float);
    std::memcpy(values.data(), &bytes[bytes.size() - std::size_t(33 - row) * block + 8],
                33 * sizeof(float));
    return values;
  }
};

TEST_F(MeasuredProgram, WritesValuesOfTriangles) {
  const ChildResult result = measured(
      {"--depth", "d.exr", "--median-depth", "m.png", "--normals", "n.png", "--alpha", "a.png"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const std::vector<float> row = exr_row("d.exr", 16);
  EXPECT_NEAR(row[16], 4, 1e-5);
  EXPECT_EQ(row[0], INFINITY);
  const Image8 depth = read_png("m.png"), normals = read_png("n.png"), alpha = read_png("a.png");
  EXPECT_EQ(alpha.at(16, 16).r, 255);
  EXPECT_EQ(alpha.at(0, 16).r, 0);
  // Towards the eye: (0, -1, 0).
  EXPECT_EQ(normals.at(16, 16), glm::u8vec4(128, 0, 128, 255));
  EXPECT_EQ(normals.at(0, 16), glm::u8vec4(0, 0, 0, 255));
  const auto json = nlohmann::json::parse(result.out);
  ASSERT_EQ(json.at("measured").size(), 4u);
  const auto& scale = json.at("measured").at(1);
  EXPECT_EQ(scale.at("path"), "m.png");
  EXPECT_EQ(scale.at("value"), "median-depth");
  const double near = scale.at("near"), far = scale.at("far");
  EXPECT_NEAR(depth.at(16, 16).r, (1 + (4 - near) / (far - near) * 65534) / 256, 1);
  EXPECT_EQ(depth.at(0, 16).r, 0);
}

TEST_F(MeasuredProgram, NumbersTheFilesAsImages) {
  write_scene();
  const ChildResult result =
      run({"render", "scene.off", "--orbit", "2", "--size", "32x32", "--depth", "d_%d.exr"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(exists("d_0.exr"));
  EXPECT_TRUE(exists("d_1.exr"));
}

TEST_F(MeasuredProgram, RejectsOtherExtensions) {
  const ChildResult result = measured({"--normals", "n.jpg"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("--normals"), std::string::npos);
  EXPECT_NE(result.err.find("n.jpg"), std::string::npos);
  EXPECT_FALSE(exists("out.png"));
}

TEST_F(MeasuredProgram, RejectsAFileWithTwoValues) {
  for (const std::vector<std::string>& names :
       {std::vector<std::string>{"--depth", "a.png", "--alpha", "./a.png"},
        std::vector<std::string>{"--alpha", "out.png"}}) {
    const ChildResult result = measured(names);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.err.find("--alpha"), std::string::npos);
    EXPECT_FALSE(exists("a.png") || exists("out.png"));
  }
}

TEST_F(MeasuredProgram, RejectsSizesBeforeItDraws) {
  write_scene();
  const ChildResult result = run({"render", "scene.off", "--size", "40000x1", "--depth", "d.exr"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("--depth supports images of at most"), std::string::npos);
  EXPECT_FALSE(exists("out.png"));
}

}  // namespace tureen::test
