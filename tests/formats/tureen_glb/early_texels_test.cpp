// Texels that are decoded before the whole file is there.
#include "formats/tureen_glb/early_texels.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <optional>

#include "formats/scene_file.hpp"
#include "tests/formats/tureen_glb/tureen_glb_kinds.hpp"
#include "tests/support/inflated.hpp"

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
  std::optional<DeflatedStrip> deflated(std::size_t index) const {
    const FileRange range = strips_[index].range();
    return deflated_strip(strips_[index], std::span(bytes_).subspan(range.offset, range.size));
  }
  /// Adds the next strip, whose index it is, with `changes` made to its lower image.
  bool add(EarlyTexels& early, std::size_t index,
           const std::function<void(std::vector<std::byte>&)>& changes = {}) const {
    const auto strip = deflated(index);
    EXPECT_TRUE(strip);
    auto low = test::inflated(strip->low), high = test::inflated(strip->high);
    if (changes) changes(low);
    return early.add(strip->low.width, low, high);
  }

  const Scene scene_ = two_strips();
  std::vector<std::byte> bytes_ = test::glb_bytes(scene_, "early");
  const std::vector<TexelStrip> strips_ = texel_strips(std::span(bytes_).first(20'000), "a.glb");
};

TEST_F(EarlyTexelsTest, AreThoseOfTheFile) {
  ASSERT_EQ(strips_.size(), 2u);
  for (std::size_t count = 0; count <= 2; ++count) {
    EarlyTexels early(strips_);
    for (std::size_t index = 0; index < count; ++index) EXPECT_TRUE(add(early, index));
    EXPECT_EQ(early.decoded_of(strips_), count);
    EXPECT_TRUE(texels_of(read(bytes_, early)) == texels_of(scene_));
  }
}

/// Changes the second byte of the first texel, which changes those below, too.
void mark(std::vector<std::byte>& low) { low[2] ^= std::byte{1}; }

TEST_F(EarlyTexelsTest, AreTaken) {
  EarlyTexels early(strips_);
  ASSERT_TRUE(add(early, 0, mark));
  EXPECT_EQ(texels_of(read(bytes_, early))[1], texels_of(scene_)[1] ^ 1);
}

TEST_F(EarlyTexelsTest, OfAnotherFileAreNotTaken) {
  auto strips = strips_;
  --strips[1].high.size;
  EarlyTexels early(strips);
  ASSERT_TRUE(add(early, 0, mark));
  EXPECT_TRUE(texels_of(read(bytes_, early)) == texels_of(scene_));
}

TEST_F(EarlyTexelsTest, EndAtADamagedStrip) {
  const auto shorten = [](std::vector<std::byte>& low) { low.resize(low.size() / 2); };
  const auto confuse = [](std::vector<std::byte>& low) { low[0] = std::byte{7}; };
  for (const std::size_t broken : {0u, 1u})
    for (const auto& damage : {std::function(shorten), std::function(confuse)}) {
      EarlyTexels early(strips_);
      for (std::size_t index = 0; index < broken; ++index) ASSERT_TRUE(add(early, index));
      EXPECT_FALSE(add(early, broken, damage));
      EXPECT_FALSE(add(early, broken));  // the reader decodes the rest
      EXPECT_EQ(early.decoded_of(strips_), broken);
      EXPECT_TRUE(texels_of(read(bytes_, early)) == texels_of(scene_));
    }
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

TEST_F(EarlyTexelsTest, NeedIntactImages) {
  EXPECT_TRUE(deflated(1));
  bytes_[std::size_t(strips_[1].high.offset) + 60] ^= std::byte{1};
  EXPECT_FALSE(deflated(1));
}

TEST_F(EarlyTexelsTest, NeedImagesOfTheirSize) {
  const FileRange range = strips_[0].range();
  for (const int more : {-1024, 1024}) {
    TexelStrip other = strips_[0];
    other.texels = std::size_t(int(other.texels) + more);
    EXPECT_FALSE(deflated_strip(other, std::span(bytes_).subspan(range.offset, range.size)));
  }
}

}  // namespace early_texels_test
}  // namespace tureen
