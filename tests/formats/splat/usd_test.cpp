// USD: fields of particles as others write them, round trips, faults, damage.
#include "formats/usd/usd.hpp"

#include <algorithm>

#include "formats/scene_file.hpp"
#include "tests/formats/format_testing.hpp"
#include "tests/formats/splat/splat_fixture.hpp"
#include "tests/formats/splat/usd_fixture.hpp"
#include "tests/formats/torch_fixture.hpp"
#include "tests/formats/truncation.hpp"
#include "tests/support/random_splats.hpp"

namespace tureen {
namespace usd_test {

using namespace test;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

Scene read(const std::string& text) { return read_usd(Input::memory("a.usda", as_bytes(text))); }

const Gaussians& gaussians_of(const Scene& scene, std::size_t layer) {
  return std::get<Gaussians>(std::get<Splats>(scene.layers.at(layer).primitives).kernel);
}

TEST(Usd, HasKnownValues) {
  const Scene scene = read(two_fields);
  ASSERT_EQ(scene.layers.size(), 2u);
  EXPECT_EQ(scene.layers[0].name, "Splat");
  EXPECT_EQ(scene.info.up, glm::vec3(0, 0, 1));
  EXPECT_FALSE(scene.info.up_is_assumed);
  EXPECT_TRUE(scene.info.remarks.empty());
  const Gaussians &splat = gaussians_of(scene, 0), &disc = gaussians_of(scene, 1);
  EXPECT_THAT(splat.centers, ElementsAre(glm::vec3(1, 2, 3)));
  EXPECT_THAT(splat.scales, ElementsAre(glm::vec3(0.5f, 0.25f, 0.1f)));
  EXPECT_THAT(splat.rotations, ElementsAre(glm::quat(0.5f, 0.5f, -0.5f, 0.5f)));
  EXPECT_THAT(splat.opacity, ElementsAre(0.75f));
  const SplatColor& color = std::get<Splats>(scene.layers[0].primitives).color;
  EXPECT_EQ(color.degree, 1);
  EXPECT_THAT(color.coefficients, ElementsAre(glm::vec3(1, 2, 3), glm::vec3(4, 5, 6),
                                              glm::vec3(7, 8, 9), glm::vec3(-1, -2, -3)));
  // Twice as large, then moved.
  EXPECT_EQ(glm::dvec3(scene.layers[0].world_from_layer * glm::dvec4(1, 2, 3, 1)),
            glm::dvec3(12, 4, 6));
  EXPECT_TRUE(disc.flat);
  EXPECT_THAT(disc.opacity, ElementsAre(1.0f));
  EXPECT_EQ(std::get<Splats>(scene.layers[1].primitives).profile, *profile_named("2dgs"));
}

TEST(Usd, LayersWithTheirPlacesReadBackBitForBit) {
  const TemporaryFolder folder;
  const SplatKind round{"", "3dgs", SplatKind::Kernel::gaussians},
      flat{"", "2dgs", SplatKind::Kernel::flat};
  Scene scene = scene_of(random_splats(round, 20, 0.1, 3), glm::dvec3(1e6 / 3, 2, 3));
  scene.layers.push_back(scene_of(random_splats(flat, 30, 0.1, 4)).layers[0]);
  scene.layers[0].name = "a house";
  scene.layers[1].visible = false;
  for (const glm::vec3& up : {glm::vec3(0, 0, 1), glm::vec3(0, -1, 0), glm::vec3(0.6f, 0.8f, 0)})
    for (const char* name : {"a.usda", "a.usdz"}) {
      scene.info.up = up;
      EXPECT_TRUE(write_scene(scene, folder / name).empty());
      const Scene found = read_scene(folder / name);
      ASSERT_EQ(found.layers.size(), 2u);
      EXPECT_EQ(found.layers[0].name, "a_house");
      EXPECT_FALSE(found.layers[1].visible);
      for (std::size_t i = 0; i < 2; ++i) {
        auto before = std::get<Splats>(scene.layers[i].primitives);
        const auto& after = std::get<Splats>(found.layers[i].primitives);
        ASSERT_EQ(count(before), count(after));
        // The reader sorts: compare as sets.
        const auto rows = [](const Splats& splats) {
          std::vector<std::vector<float>> all;
          for (std::size_t k = 0; k < count(splats); ++k) {
            all.push_back(values_of(splats.kernel, k));
            const std::size_t each = coefficients_per_splat(splats.color);
            for (std::size_t c = 0; c < each; ++c)
              for (int rgb = 0; rgb < 3; ++rgb)
                all.back().push_back(splats.color.coefficients[each * k + c][rgb]);
          }
          std::sort(all.begin(), all.end());
          return all;
        };
        auto& discs = std::get<Gaussians>(before.kernel);
        if (discs.flat)
          for (glm::vec3& scales : discs.scales) scales.z = 0;
        EXPECT_EQ(rows(after), rows(before));
        // Up stays up, where the splats are.
        const glm::dvec3 turned = glm::dmat3(found.layers[i].world_from_layer) * glm::dvec3(up);
        EXPECT_LT(glm::length(turned - glm::dvec3(found.info.up)), 1e-6);
      }
    }
}

TEST(Usd, FaultsNameTheLineAndTheWayOut) {
  const auto changed = [](const std::string& from, const std::string& to) {
    std::string text = two_fields;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
    return error_of([&] { read(text); });
  };
  EXPECT_THAT(changed("(0.5, 0.5, -0.5, 0.5)", "(0.5, 0.5, -0.5)"),
              ErrorIn("a.usda", "3 numbers of orientations"));
  EXPECT_THAT(changed("Degree = 1", "Degree = 5"), ErrorIn("a.usda", "0 to 4"));
  EXPECT_THAT(changed("[0.75]", "[0.75"), ErrorIn("a.usda", "number"));
  EXPECT_THAT(changed("GaussianSurflet", "ConstantSurflet"),
              ErrorIn("a.usda", "constant surflets"));
  EXPECT_THAT(changed("[\"xformOp:scale\"]", "[\"xformOp:rotateX\"]"),
              ErrorIn("a.usda", "xformOp:rotateX"));
  std::string many = "[\"xformOp:scale\"";
  for (int i = 0; i < 64; ++i) many += ", \"xformOp:scale\"";
  EXPECT_THAT(changed("[\"xformOp:scale\"]", many + "]"), ErrorIn("a.usda", 64));
  EXPECT_THAT(changed("(2, 2, 2)", "(2, 2, 1)"), ErrorIn("a.usda", "stretches"));
  EXPECT_THAT(error_of([] { read("PXR-USDC\0\0"); }), ErrorIn("a.usda", "usdcat"));
  EXPECT_THAT(error_of([] { read("#usda 1.0\ndef Mesh \"a\" { int[] n = [3] }"); }),
              ErrorIn("a.usda", "ParticleField3DGaussianSplat"));
  ZipFixture zip;
  zip.entries = {{"scene.usdc", "PXR-USDC"}};
  const std::string bytes = zip.bytes();
  EXPECT_THAT(error_of([&] { read_usd(Input::memory("a.usdz", as_bytes(bytes))); }),
              ErrorIn("a.usdz/scene.usdc", "usdcat"));
  EXPECT_THROW(write_usd(scene_of(random_splats(splat_kinds[0], 3, 0.1, 1)), "a.usda"), UsageError);
}

TEST(Usd, ParentsPlaceHideAndDescribe) {
  const auto with_parent = [](const std::string& type, const std::string& properties) {
    std::string text = two_fields;
    text.replace(text.find("def Xform"), 9, type);
    return text.insert(text.find("double3 xformOp:translate"), properties + "\n    ");
  };
  for (const Layer& layer :
       read(with_parent("def Xform", "token visibility = \"invisible\"")).layers)
    EXPECT_FALSE(layer.visible) << layer.name;
  EXPECT_THAT(error_of([&] { read(with_parent("class Xform", "")); }),
              ErrorIn("a.usda", "ParticleField3DGaussianSplat"));
  std::string text = two_fields;
  text.replace(text.find("[\"xformOp:translate\"]"), 21,
               "[\"xformOp:translate\", \"xformOp:rotateX\"]");
  EXPECT_THAT(error_of([&] { read(text); }), ErrorIn("a.usda", "xformOp:rotateX", "World"));
}

TEST(Usd, SurvivesDamage) {
  const auto read_bytes = [](std::span<const std::byte> bytes) {
    for (const Layer& layer : read_usd(Input::memory("a.usda", bytes)).layers) {
      EXPECT_EQ(defect(layer), std::nullopt);
      EXPECT_EQ(defect(std::get<Splats>(layer.primitives)), std::nullopt);
    }
  };
  EXPECT_LE(survive_truncation(as_bytes(two_fields), read_bytes).read, 1u);  // the last line end
  survive_damage(as_bytes(two_fields), read_bytes, Damage::one);
}

TEST(Usd, AnArchiveSurvivesDamageAtEveryByte) {
  const TemporaryFolder folder;
  const SplatKind kind{"", "3dgs", SplatKind::Kernel::gaussians};
  write_scene(scene_of(random_splats(kind, 2, 0.1, 7)), folder / "a.usdz");
  const std::vector<std::byte> bytes = Input::open(folder / "a.usdz").read_rest();
  const auto read_bytes = [](std::span<const std::byte> damaged) {
    for (const Layer& layer : read_usd(Input::memory("a.usdz", damaged)).layers) {
      EXPECT_EQ(defect(layer), std::nullopt);
      EXPECT_EQ(defect(std::get<Splats>(layer.primitives)), std::nullopt);
    }
  };
  EXPECT_EQ(survive_truncation(bytes, read_bytes).read, 0u);
  EXPECT_GT(survive_damage(bytes, read_bytes).refused, 100u);
}

}  // namespace usd_test
}  // namespace tureen
