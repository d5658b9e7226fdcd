// Texels that are decoded before the whole file is there.
#include "formats/early_texels.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "formats/scene_file.hpp"
#include "tests/formats/tureen_glb/tureen_glb_kinds.hpp"
#include "tests/support/errors.hpp"

namespace tureen {
namespace early_texels_test {

/// A soup whose texels need two strips: 131 faces at level 7 have 1,098,435 texels.
Scene two_strips() {
  test::RandomScene random(131);
  LatticeTexture texture;
  const std::uint32_t each = lattice::texel_count(lattice::max_level);
  for (std::uint32_t face = 0; face < 131; ++face)
    texture.patches.push_back({face * each, lattice::max_level});
  std::vector<std::uint8_t> values(std::size_t(131) * each * LatticeTexture::channels);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::uint8_t(i / 1000);
  texture.texels = std::move(values);
  Scene scene;
  scene.layers.emplace_back();
  test::fill_soup(scene, random.geometry(131, false), std::move(texture));
  return scene;
}

std::vector<std::uint8_t> texels_of(const Scene& scene) {
  return std::get<std::vector<std::uint8_t>>(
      std::get<LatticeTexture>(only_soup(scene).appearance).texels);
}

Scene read(std::span<const std::byte> bytes, EarlyTexels early) {
  Input input = Input::memory("a.glb", bytes);
  return read_tureen_glb(input, {.early_texels = &early});
}

class EarlyTexelsTest : public testing::Test {
 protected:
  std::vector<std::uint8_t> decoded(std::size_t index) const {
    const FileRange range = strips_[index].range();
    return decode_strip(strips_[index], std::span(bytes_).subspan(range.offset, range.size),
                        "a.glb");
  }
  /// With an error, to tell them from those that the reader decodes.
  std::vector<std::uint8_t> marked(std::size_t index) const {
    auto texels = decoded(index);
    texels[5] ^= 1;
    return texels;
  }

  const Scene scene_ = two_strips();
  std::vector<std::byte> bytes_ = test::glb_bytes(scene_, "early");
  const std::vector<TexelStrip> strips_ = texel_strips(std::span(bytes_).first(20'000), "a.glb");
};

TEST_F(EarlyTexelsTest, AreThoseOfTheFileInAnyOrder) {
  ASSERT_EQ(strips_.size(), 2u);
  for (const auto& order : {std::vector<std::size_t>{}, {0}, {0, 1}, {1, 0}}) {
    EarlyTexels early(strips_);
    for (const std::size_t index : order) early.add(index, decoded(index));
    EXPECT_EQ(early.decoded_of(strips_), order.size());
    EXPECT_TRUE(texels_of(read(bytes_, early)) == texels_of(scene_));
  }
}

TEST_F(EarlyTexelsTest, AreTaken) {
  EarlyTexels early(strips_);
  early.add(0, marked(0));
  std::vector<std::uint8_t> expected = texels_of(scene_);
  expected[5] ^= 1;
  EXPECT_TRUE(texels_of(read(bytes_, early)) == expected);
}

TEST_F(EarlyTexelsTest, WaitForTheStripsBefore) {
  EarlyTexels early(strips_);
  early.add(1, marked(1));
  EXPECT_EQ(early.decoded_of(strips_), 0u);
  EXPECT_TRUE(texels_of(read(bytes_, early)) == texels_of(scene_));
}

TEST_F(EarlyTexelsTest, OfAnotherFileAreNotTaken) {
  auto strips = strips_;
  --strips[1].high.size;
  EarlyTexels early(strips);
  early.add(0, marked(0));
  EXPECT_TRUE(texels_of(read(bytes_, early)) == texels_of(scene_));
}

TEST_F(EarlyTexelsTest, HaveStripsOnceTheHeaderIsThere) {
  std::uint32_t json_size = 0;
  std::memcpy(&json_size, &bytes_[12], 4);
  const std::size_t header = 20 + json_size + 8;
  for (std::size_t length = 0; length < header; ++length)
    EXPECT_TRUE(texel_strips(std::span(bytes_).first(length), "a.glb").empty()) << length;
  EXPECT_EQ(texel_strips(std::span(bytes_).first(header), "a.glb"), strips_);
}

TEST_F(EarlyTexelsTest, AreThoseOfTheOnlyLayer) {
  Scene scene = scene_;
  scene.layers[0].name = "one";
  scene.layers[0].world_from_layer[3].x = 1;
  EXPECT_EQ(texel_strips(test::glb_bytes(scene, "early_layer"), "a.glb").size(), 2u);
  scene.layers.push_back(scene.layers[0]);
  EXPECT_TRUE(texel_strips(test::glb_bytes(scene, "early_layers"), "a.glb").empty());
}

TEST_F(EarlyTexelsTest, OfADamagedImageAreAnError) {
  bytes_[std::size_t(strips_[1].high.offset) + 60] ^= std::byte{1};
  EXPECT_THROW(decoded(1), InputError);
}

}  // namespace early_texels_test
}  // namespace tureen
