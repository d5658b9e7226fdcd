// Texels that are decoded before the whole file is there.
#include "formats/early_texels.hpp"

#include <gtest/gtest.h>

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
  EarlyTexels decoded(std::size_t count) const {
    EarlyTexels early;
    for (const TexelStrip& strip : std::span(strips_).first(count)) {
      const FileRange range = strip.range();
      decode_strip(strip, std::span(bytes_).subspan(range.offset, range.size), "a.glb",
                   early.texels);
      early.strips.push_back(strip);
    }
    return early;
  }

  const Scene scene_ = two_strips();
  std::vector<std::byte> bytes_ = test::glb_bytes(scene_, "early");
  const std::vector<TexelStrip> strips_ = texel_strips(std::span(bytes_).first(20'000), "a.glb");
};

TEST_F(EarlyTexelsTest, AreThoseOfTheFile) {
  ASSERT_EQ(strips_.size(), 2u);
  for (const std::size_t count : {0, 1, 2}) {
    SCOPED_TRACE(count);
    EarlyTexels early = decoded(count);
    EXPECT_TRUE(texels_of(read(bytes_, early)) == texels_of(scene_));
    if (count == 0) continue;
    early.texels[5] ^= 1;
    EXPECT_FALSE(texels_of(read(bytes_, early)) == texels_of(scene_)) << "they were not taken";
  }
}

TEST_F(EarlyTexelsTest, OfAnotherFileAreNotTaken) {
  EarlyTexels early = decoded(1);
  early.texels[5] ^= 1;
  --early.strips[0].low.size;
  EXPECT_TRUE(texels_of(read(bytes_, early)) == texels_of(scene_));
  early = decoded(2);
  early.texels[5] ^= 1;
  early.strips.push_back(early.strips.back());
  EXPECT_TRUE(texels_of(read(bytes_, early)) == texels_of(scene_));
}

TEST_F(EarlyTexelsTest, HaveNoStripsWithoutTheHeader) {
  EXPECT_TRUE(texel_strips(std::span(bytes_).first(100), "a.glb").empty());
  EXPECT_TRUE(texel_strips({}, "a.glb").empty());
}

TEST_F(EarlyTexelsTest, OfADamagedImageStayAsTheyWere) {
  bytes_[std::size_t(strips_[1].high.offset) + 60] ^= std::byte{1};
  EarlyTexels early = decoded(1);
  const std::size_t before = early.texels.size();
  const FileRange range = strips_[1].range();
  EXPECT_THROW(decode_strip(strips_[1], std::span(bytes_).subspan(range.offset, range.size),
                            "a.glb", early.texels),
               InputError);
  EXPECT_EQ(early.texels.size(), before);
  EXPECT_THROW(read(bytes_, early), InputError);
}

}  // namespace early_texels_test
}  // namespace tureen
