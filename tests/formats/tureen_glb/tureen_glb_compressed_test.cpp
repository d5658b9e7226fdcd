// Compressed files: the reader restores exactly the soup that the encoder returned.
#include "formats/tureen_glb/tureen_glb_compressed.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "formats/tureen_glb/tureen_glb.hpp"
#include "tests/formats/random_scene.hpp"
#include "tests/formats/truncation.hpp"
#include "tests/formats/tureen_glb/tureen_glb_kinds.hpp"
#include "tests/support/errors.hpp"

namespace tureen {
namespace tureen_glb_compressed_test {

using test::error_of;
using test::Names;
using test::RandomScene;

Scene random_scene(unsigned seed, std::size_t faces, std::optional<int> level, bool shared) {
  RandomScene random(seed);
  Scene scene = random.scene();
  TriangleSoup soup = random.geometry(faces, shared);
  LatticeTexture texture = random.lattice_texture(faces, level, false);
  texture.mlp = random.diffsoup_mlp();
  soup.appearance = std::move(texture);
  only_soup(scene) = std::move(soup);
  return scene;
}

std::vector<std::byte> bytes_of_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

std::vector<std::byte> written(const Scene& scene, const CompressedSoup& compressed,
                               const std::string& name) {
  const auto path = std::filesystem::path(::testing::TempDir()) / ("compressed_" + name + ".glb");
  EXPECT_TRUE(write_compressed_glb(scene, compressed, path).empty());
  auto bytes = bytes_of_file(path);
  std::filesystem::remove(path);
  return bytes;
}

Scene read_back(std::span<const std::byte> bytes) {
  Input input = Input::memory("memory.glb", bytes);
  return read_tureen_glb(input);
}

std::vector<std::byte> without_checksums(std::span<const std::byte> bytes) {
  auto json = test::glb_json(bytes);
  auto& extension = json["extensions"][tureen_extension];
  EXPECT_EQ(extension.erase("slim_geometry_crc32"), 1u);
  EXPECT_EQ(extension["appearance"].erase("slim_texels_crc32"), 1u);
  return test::with_glb_json(bytes, json);
}

TEST(CompressedGlb, IsReadAsTheEncoderSaid) {
  for (unsigned seed = 91; seed < 97; ++seed) {
    const bool shared = seed % 2 == 0;
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    Scene scene = random_scene(seed, 30, seed % 3 ? std::optional<int>(2) : std::nullopt, shared);
    const auto& soup = only_soup(scene);
    const CompressedSoup compressed = encode_compressed(
        soup, {.position_bits = 12, .texels = {.feature_step = 9, .alpha_step = 85}});
    TriangleSoup promised = decode_compressed(compressed, soup);
    EXPECT_EQ(promised.triangles.size(), 30u);
    EXPECT_FALSE(defect(promised));
    const Scene back = read_back(written(scene, compressed, std::to_string(seed)));
    only_soup(scene) = std::move(promised);
    EXPECT_EQ(test::difference(scene, back), "");
  }
}

TEST(CompressedGlb, TellsOtherViewersThatItIsNotForThem) {
  Scene scene = random_scene(98, 4, 1, false);
  const CompressedSoup compressed = encode_compressed(only_soup(scene), {});
  const auto json = test::glb_json(written(scene, compressed, "required"));
  EXPECT_EQ(json["extensionsRequired"], nlohmann::json::array({tureen_extension}));
  EXPECT_EQ(json["extensions"][tureen_extension]["version"], tureen_compressed_version);
  EXPECT_FALSE(json.contains("meshes"));
}

TEST(CompressedGlb, HoldsLatticeTexturesOnly) {
  RandomScene random(99);
  Scene scene = random.scene();
  TriangleSoup soup = random.geometry(2, false);
  soup.appearance = FaceColors{random.colors(2, true)};
  only_soup(scene) = std::move(soup);
  EXPECT_THROW(write_compressed_glb(scene, {}, "never_written.glb"), UsageError);
  EXPECT_FALSE(std::filesystem::exists("never_written.glb"));
}

TEST(CompressedGlb, AnEmptySoupComesBackEmpty) {
  TriangleSoup soup;
  soup.appearance = LatticeTexture{};
  const Scene scene = scene_of(soup);
  const CompressedSoup compressed = encode_compressed(soup, {});
  const Scene back = read_back(written(scene, compressed, "empty"));
  EXPECT_TRUE(only_soup(back).triangles.empty());
}

TEST(CompressedGlb, SurvivesDamage) {
  Scene scene = random_scene(100, 3, 0, false);
  scene.cameras.clear();
  // The network is stored as in other files, and takes thousands of bytes.
  std::get<LatticeTexture>(only_soup(scene).appearance).mlp.reset();
  const CompressedSoup compressed =
      encode_compressed(only_soup(scene), {.texels = {.feature_step = 16, .alpha_step = 85}});
  // Without checksums, the damage reaches the decoders.
  const auto bytes = without_checksums(written(scene, compressed, "damage"));
  const auto read = [](std::span<const std::byte> b) {
    const Scene back = read_back(b);
    ASSERT_FALSE(defect(only_soup(back)));
  };
  EXPECT_EQ(test::survive_truncation(bytes, read).read, 0u);
  EXPECT_GT(test::survive_damage(bytes, read).refused, 0u);
}

TEST(CompressedGlb, DamageIsToldByChecksums) {
  Scene scene = random_scene(102, 20, 2, false);
  const CompressedSoup compressed = encode_compressed(only_soup(scene), {});
  auto bytes = written(scene, compressed, "checksum");
  for (const auto& [key, array] : {std::pair("slim_geometry", compressed.geometry),
                                   std::pair("slim_texels", compressed.texels)}) {
    const auto found = std::search(bytes.begin(), bytes.end(), array.begin(), array.end());
    ASSERT_NE(found, bytes.end());
    // A decoder cannot detect this damage: the last bytes carry little or no information.
    for (std::size_t back = 1; back <= 20; ++back) {
      SCOPED_TRACE(back);
      std::byte& byte = *(found + std::ptrdiff_t(array.size() - back));
      byte ^= std::byte{1};
      EXPECT_THAT(error_of([&] { read_back(bytes); }), Names(key));
      byte ^= std::byte{1};
    }
  }
  EXPECT_NO_THROW(read_back(bytes));
  EXPECT_NO_THROW(read_back(without_checksums(bytes))) << "earlier files have no checksums";
}

TEST(CompressedGlb, CountsThatDoNotFitAreRefused) {
  Scene scene = random_scene(101, 5, 1, false);
  const CompressedSoup compressed = encode_compressed(only_soup(scene), {});
  const auto bytes = written(scene, compressed, "counts");
  const auto json = test::glb_json(bytes);
  for (const auto& [key, value] :
       {std::pair("face_count", 4000000000u), std::pair("vertex_count", 4000000000u),
        std::pair("vertex_count", 14u)}) {
    auto changed = json;
    changed["extensions"][tureen_extension][key] = value;
    EXPECT_NE(error_of([&] { read_back(test::with_glb_json(bytes, changed)); }), std::nullopt)
        << key << " of " << value;
  }
}

}  // namespace tureen_glb_compressed_test
}  // namespace tureen
