// Program tests of `tureen convert --compress`: its file, and the loss that it reports.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "formats/scene_file.hpp"
#include "tests/cli/photographs_fixture.hpp"
#include "tests/support/errors.hpp"

namespace tureen {
namespace convert_compressed_program_test {

namespace fs = std::filesystem;
using test::ChildResult;
using test::Names;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

const std::string example = TUREEN_SOURCE_DIR "/examples/soup.glb";

class ConvertCompress : public test::ProgramWithPhotographs {
 protected:
  /// The size of a scene as a DiffSoup export (two PNGs, a PLY and JSON), divided by that of `glb`.
  double times_smaller(const std::string& scene, const std::string& glb) {
    EXPECT_EQ(run({"convert", scene, "export/"}).exit_code, 0);
    std::uintmax_t bytes = 0;
    for (const auto& file : fs::directory_iterator(folder / "export")) bytes += file.file_size();
    return double(bytes) / double(fs::file_size(folder / glb));
  }
};

TEST_F(ConvertCompress, IsSmallAndSaysWhatItLost) {
  Scene scene = read_scene(example);
  auto& soup = only_soup(scene);
  soup.triangles.resize(400);
  std::get<LatticeTexture>(soup.appearance).patches.resize(400);
  scene.cameras.resize(2);
  for (Camera& camera : scene.cameras) camera = resized(camera, 160, 120);
  ASSERT_THAT(tureen::write_scene(scene, folder / "part.glb"), IsEmpty());

  const ChildResult result =
      run({"convert", "part.glb", "compressed.glb", "--compress", "--max-error", "0.3", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_LE(json["loss_db"], 0.3);
  EXPECT_EQ(json["loss_is_measured"], false);
  EXPECT_EQ(json["bytes_on_disk"], fs::file_size(folder / "compressed.glb"));
  // All of the example becomes smaller (docs/compressed-files.md). In this part, JSON and network
  // take a larger share.
  EXPECT_GT(times_smaller("part.glb", "compressed.glb"), 3);

  const Scene back = read_scene(folder / "compressed.glb");
  EXPECT_EQ(only_soup(back).triangles.size(), 400u);
  EXPECT_EQ(back.cameras.size(), 1u);
  // The file stores the losses, except those of writing the file itself.
  ASSERT_THAT(back.info.notes, Not(IsEmpty()));
  EXPECT_THAT(json["lost"], testing::Contains(back.info.notes.back()));
  EXPECT_THAT(run({"info", "compressed.glb"}).err, HasSubstr(back.info.notes.back()));

  // Conditions that weaken the reported loss.
  EXPECT_EQ(json["recorded_cameras"], 2);
  EXPECT_EQ(json["compressed_before"], false);
  const ChildResult again = run(
      {"convert", "compressed.glb", "COMPRESSED.GLB", "--compress", "--max-error", "3", "--json"});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(nlohmann::json::parse(again.out)["compressed_before"], true);
  const ChildResult finer =
      run({"convert", "part.glb", "fine.glb", "--compress", "--max-error", "0.0001"});
  EXPECT_EQ(finer.exit_code, 2);
  EXPECT_THAT(finer.err, Names("0.0001 dB"));
  EXPECT_FALSE(exists("fine.glb"));

  const ChildResult ply = run({"convert", "part.glb", "compressed.ply", "--compress"});
  EXPECT_EQ(ply.exit_code, 2);
  EXPECT_THAT(ply.err, Names("--compress", ".glb", ".html", "compressed.ply"));
  EXPECT_EQ(run({"convert", "part.glb", "other.glb", "--max-error", "1"}).exit_code, 2);
  const ChildResult scale = run({"convert", "part.glb", "other.glb", "--scale", "2"});
  EXPECT_EQ(scale.exit_code, 2);
  EXPECT_THAT(scale.err, HasSubstr("--resize 2 enlarges the scene"));
  EXPECT_THAT(run({"eval", "part.glb", "none", "--scale", "2"}).err, Not(HasSubstr("--resize")));
}

// The target for compressed files (docs/compressed-files.md), without photographs; the whole
// example takes most of a minute, and IsSmallAndSaysWhatItLost has a part of it.
using ThoroughConvertCompress = ConvertCompress;
TEST_F(ThoroughConvertCompress, MakesTheExampleFourTimesSmallerForATenthOfADecibel) {
  const ChildResult result = run({"convert", example, "compressed.glb", "--compress", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_GE(times_smaller(example, "compressed.glb"), 4);
  EXPECT_LE(json["loss_db"], 0.1);
  EXPECT_EQ(json["scene_bytes"], fs::file_size(folder / "compressed.glb"));
}

// The search only compares how close images are to the photographs.
TEST_F(ConvertCompress, PhotographsOfAnotherSceneAreRefused) {
  Scene scene = read_scene(example);
  auto& soup = only_soup(scene);
  soup.triangles.resize(400);
  std::get<LatticeTexture>(soup.appearance).patches.resize(400);
  scene.cameras.clear();
  ASSERT_THAT(tureen::write_scene(scene, folder / "part.glb"), IsEmpty());
  // As close as a trained scene is to its photographs.
  const glm::vec3 background = scene.info.background;
  scene.info.background = glm::mix(background, glm::vec3(0.5f), 0.1f);
  ASSERT_THAT(tureen::write_scene(scene, folder / "near.glb"), IsEmpty());
  // No triangle is visible, and the background is bright instead of dark.
  scene.info.background = glm::vec3(1) - background;
  soup.positions.assign(soup.positions.size(), glm::vec3(0));
  ASSERT_THAT(tureen::write_scene(scene, folder / "other.glb"), IsEmpty());
  const auto compress = [&] {
    return run({"convert", "part.glb", "compressed.glb", "--compress", "--photographs", "data",
                "--max-error", "20", "--force", "--json"});
  };
  photograph("other.glb", 8);
  const ChildResult refused = compress();
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, Names("--photographs"));
  EXPECT_FALSE(fs::exists(folder / "compressed.glb"));
  const auto lost = [&] {
    const ChildResult result = compress();
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const auto json = nlohmann::json::parse(result.out);
    EXPECT_EQ(json["loss_is_measured"], true);
    return std::pair{json, result.err};
  };
  photograph("near.glb", 8);
  EXPECT_EQ(lost().first["training_cameras"], 8);
  // The photographs are optional: without them, the search uses the scene alone.
  fs::remove_all(folder / "data/train");
  const auto [json, said] = lost();
  EXPECT_EQ(json["training_cameras"], 0);
  EXPECT_THAT(json["lost"].dump(), Not(HasSubstr("r_3"))) << "the file stores this text";
  EXPECT_THAT(said, HasSubstr("r_3"));
}

}  // namespace convert_compressed_program_test
}  // namespace tureen
