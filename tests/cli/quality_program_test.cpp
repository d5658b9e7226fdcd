// The program applies the quality from a scene's file, and edits of its data.
#include <gmock/gmock.h>

#include "formats/scene_file.hpp"
#include "formats/tureen_glb/tureen_glb.hpp"
#include "tests/cli/program_fixture.hpp"

namespace tureen::test {
namespace quality_program_test {

const std::filesystem::path example =
    std::filesystem::path(TUREEN_SOURCE_DIR) / "examples/soup.glb";

class QualityProgram : public Program {
 protected:
  /// Writes the example with this quality.
  void write_fine(const Quality& quality) const {
    Scene scene = read_scene(example);
    scene.quality = quality;
    write_tureen_glb(scene, folder / "fine.glb");
  }
  Image8 drawn(const std::string& scene, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"render",    scene,    "--size", "80x60",
                                          "--context", "osmesa", "-o",     "picture.png"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ChildResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return read_png("picture.png");
  }
};

TEST_F(QualityProgram, RenderAppliesItUnlessToldOtherwise) {
  write_fine({.supersampling = 3});
  const std::string plain = example.string();
  const Image8 fine = drawn(plain, {"--supersample", "3"}), coarse = drawn(plain);
  ASSERT_NE(fine.pixels, coarse.pixels);
  EXPECT_TRUE(drawn("fine.glb").pixels == fine.pixels);
  EXPECT_TRUE(drawn("fine.glb", {"--supersample", "1"}).pixels == coarse.pixels);
  EXPECT_TRUE(drawn("fine.glb", {"--scale", "0.5"}).pixels ==
              drawn(plain, {"--scale", "0.5"}).pixels);
  const auto info = nlohmann::json::parse(run({"info", "fine.glb", "--json"}).out);
  EXPECT_EQ(info["quality"]["supersampling"], 3);
  EXPECT_EQ(info["quality"]["resolution_scale"], 1);
}

TEST_F(QualityProgram, ConvertKeepsIt) {
  write_fine({.resolution_scale = 0.5});
  ASSERT_EQ(run({"convert", "fine.glb", "again.glb"}).exit_code, 0);
  EXPECT_EQ(read_scene(folder / "again.glb").quality, (Quality{.resolution_scale = 0.5}));
}

TEST_F(QualityProgram, ConvertStoresIt) {
  const auto stored = [&](const std::string& option, const std::string& value) {
    EXPECT_EQ(run({"convert", example.string(), "set.glb", "--force", option, value}).exit_code, 0);
    return read_scene(folder / "set.glb").quality;
  };
  EXPECT_EQ(stored("--supersample", "2"), (Quality{.supersampling = 2}));
  EXPECT_EQ(stored("--resolution-scale", "0.75"), (Quality{.resolution_scale = 0.75}));
  EXPECT_EQ(stored("--splat-order", "exact"), (Quality{.splat_order = Quality::SplatOrder::exact}));
  EXPECT_EQ(run({"convert", example.string(), "both.glb", "--supersample", "2",
                 "--resolution-scale", "0.5"})
                .exit_code,
            2);
  EXPECT_EQ(run({"convert", example.string(), "set.off", "--supersample", "2"}).exit_code, 2);
}

TEST_F(QualityProgram, ConvertAppliesEdits) {
  const ChildResult result = run({"convert", example.string(), "less.glb", "--lattice-level", "1",
                                  "--color", "baked", "--texel-bits", "8"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Scene scene = read_scene(folder / "less.glb");
  const auto& texture = std::get<LatticeTexture>(only_soup(scene).appearance);
  EXPECT_FALSE(texture.mlp);
  EXPECT_FALSE(texture.is_float());
  for (const LatticePatch& patch : texture.patches) EXPECT_LE(patch.level, 1u);

  write("face.off", "COFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 255 0 0\n");
  EXPECT_EQ(run({"convert", "face.off", "face.glb", "--lattice-level", "1"}).exit_code, 2);
  EXPECT_FALSE(exists("face.glb"));
  EXPECT_EQ(run({"convert", example.string(), "worse.glb", "--lattice-level", "8"}).exit_code, 2);
}

}  // namespace quality_program_test
}  // namespace tureen::test
