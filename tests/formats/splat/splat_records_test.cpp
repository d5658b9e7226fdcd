#include "formats/splat/splat_records.hpp"

#include <cmath>
#include <fstream>

#include "formats/common/format_remarks.hpp"
#include "formats/scene_file.hpp"
#include "tests/formats/format_testing.hpp"
#include "tests/formats/splat/splat_fixture.hpp"
#include "tests/formats/truncation.hpp"

namespace tureen {
namespace splat_records_test {

using namespace test;
using ::testing::ElementsAre;

std::string record(std::initializer_list<float> floats, std::initializer_list<int> bytes) {
  std::string text;
  for (const float value : floats) text.append(reinterpret_cast<const char*>(&value), sizeof value);
  for (const int byte : bytes) text += static_cast<char>(byte);
  return text;
}

const std::string valid = record({1, 2, 3, 0, 0.5f, 4}, {255, 0, 51, 102, 255, 128, 0, 128});

TEST(SplatRecords, ReadsKnownValues) {
  Input input = input_of(valid, "folder/a.splat");
  const Scene scene = read_splat_records(input);
  const Gaussians& g = only_gaussians(scene);
  EXPECT_THAT(g.centers, ElementsAre(glm::vec3(1, 2, 3)));
  EXPECT_THAT(g.scales, ElementsAre(glm::vec3(0, 0.5f, 4)));
  EXPECT_THAT(g.opacity, ElementsAre(102 / 255.0f));
  const double part = 128 / 127.5 - 1;
  const glm::dquat q = glm::normalize(glm::dquat(1, part, -1, part));
  EXPECT_LT(glm::length(g.rotations[0] - glm::quat(q)), 1e-6f);
  EXPECT_LT(glm::length(only_splats(scene).color.coefficients[0] -
                        glm::vec3(0.5f, -0.5f, -0.3f) / float(harmonics::y00)),
            1e-6f);
  EXPECT_EQ(only_splats(scene).profile, *profile_named("3dgs"));
  EXPECT_EQ(scene.info.up, glm::vec3(0, -1, 0));
  EXPECT_EQ(scene.info.name, "a");
}

TEST(SplatRecords, DropsInvalidSplats) {
  const std::string nan = record({NAN, 2, 3, 1, 1, 1}, {0, 0, 0, 0, 255, 0, 0, 0});
  const std::string negative = record({0, 0, 0, -1, 1, 1}, {0, 0, 0, 0, 255, 0, 0, 0});
  const std::string text = valid + nan + negative + valid;
  Input input = input_of(text);
  const Scene scene = read_splat_records(input);
  EXPECT_EQ(only_gaussians(scene).centers.size(), 2u);
  EXPECT_EQ(scene.info.remarks.back(),
            (Remark{&remarks::splats_dropped, {{"dropped", 2}, {"all", 4}}}));
  EXPECT_EQ(defect(only_splats(scene)), std::nullopt);
}

TEST(SplatRecords, P3_AZeroQuaternionIsAUnitRotation) {
  // Writers round 0 to 127 or 128, where no byte means 0. Bytes of 0 are parts of -1.
  for (const int byte : {0, 127, 128, 255}) {
    const std::string text = record({1, 2, 3, 1, 1, 1}, {9, 9, 9, 9, byte, byte, byte, byte});
    Input input = input_of(text);
    const Scene scene = read_splat_records(input);
    const glm::quat q = only_gaussians(scene).rotations.at(0);
    EXPECT_NEAR(glm::length(q), 1, 1e-6) << byte;
    for (int k = 1; k < 4; ++k) EXPECT_EQ(q[k], q[0]) << byte;
    EXPECT_EQ(defect(only_splats(scene)), std::nullopt);
  }
}

TEST(SplatRecords, AreRecognisedByExtensionAndSize) {
  const TemporaryFolder folder;
  std::string many;
  for (int i = 0; i < 300; ++i) many += valid;
  std::ofstream(folder / "a.splat", std::ios::binary) << many;
  EXPECT_EQ(count(only_splats(read_scene(folder / "a.splat"))), 300u);
  std::ofstream(folder / "b.splat", std::ios::binary) << valid << "x";
  EXPECT_FALSE(is_scene(folder / "b.splat"));
  EXPECT_THAT(error_of([&] { read_scene(folder / "b.splat"); }),
              ErrorAt((folder / "b.splat").string() + "@32", 32, 1));
  std::ofstream(folder / "c.bin", std::ios::binary) << valid;
  EXPECT_FALSE(is_scene(folder / "c.bin"));
}

TEST(SplatRecords, SurviveTruncationAndDamage) {
  const std::string text = valid + valid;
  const auto read = [](std::span<const std::byte> bytes) {
    Input input = Input::memory("a.splat", bytes);
    const Scene scene = read_splat_records(input);
    EXPECT_EQ(defect(only_splats(scene)), std::nullopt);
  };
  const auto bytes = std::as_bytes(std::span(text));
  EXPECT_EQ(survive_truncation(bytes, read).read, 2u);  // 0 and 32 bytes
  EXPECT_EQ(survive_damage(bytes, read).refused, 0u);
}

}  // namespace splat_records_test
}  // namespace tureen
