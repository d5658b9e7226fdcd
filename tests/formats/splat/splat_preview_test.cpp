// The first splats of a file that is arriving equal those of a file that ends there.
#include <gtest/gtest.h>

#include "formats/scene_preview.hpp"
#include "formats/splat/splat_ply.hpp"
#include "formats/splat/splat_records.hpp"
#include "scene/edit/splat_edits.hpp"
#include "tests/formats/random_scene.hpp"
#include "tests/formats/truncation.hpp"

namespace tureen {
namespace splat_preview_test {

using Bytes = std::span<const std::byte>;

constexpr std::size_t first_splats = 16384;

std::vector<std::byte> ply_of(const Splats& splats) {
  const auto path = std::filesystem::path(::testing::TempDir()) / "splat_preview.ply";
  write_splat_ply(scene_of(splats), path);
  auto bytes = Input::open(path).read_rest();
  std::filesystem::remove(path);
  return bytes;
}

std::vector<std::byte> ply_with(std::size_t splats) {
  test::RandomScene random(1);
  return ply_of(random.gaussians(splats, 1, "3dgs", false));
}

TEST(SplatPreview, GrowsUntilTheFileIsWhole) {
  const std::vector<std::byte> bytes = ply_with(3 * first_splats);
  const auto first = preview_size(bytes, "a.ply", 0).value();
  EXPECT_TRUE(first.has_splats);
  EXPECT_EQ(count(std::get<Splats>(
                only_layer(*read_preview(Bytes(bytes).first(std::size_t(first.bytes)), "a.ply"))
                    .primitives)),
            first_splats);
  const auto second = preview_size(bytes, "a.ply", first.bytes).value();
  EXPECT_GT(second.bytes, first.bytes);
  EXPECT_EQ(preview_size(bytes, "a.ply", second.bytes).value().bytes, 0u);
  EXPECT_EQ(preview_size(bytes, "a.ply", bytes.size()).value().bytes, 0u);
}

TEST(SplatPreview, HasTheFirstSplats) {
  test::RandomScene random(1);
  const Splats ten = random.gaussians(10, 1, "3dgs", false);
  std::vector<std::uint8_t> keeps(10, 1);
  const std::vector<std::byte> bytes = ply_of(ten);
  // A row of degree 1 has 26 floats: 104 bytes.
  for (const std::size_t rows : {9u, 8u}) {
    keeps[rows] = 0;
    const auto preview =
        read_preview(Bytes(bytes).first(bytes.size() - 104 * (9 - rows) - 1), "a.ply");
    const auto whole = read_preview(ply_of(keep_splats(ten, keeps)), "a.ply");
    ASSERT_TRUE(preview && whole);
    EXPECT_EQ(count(std::get<Splats>(only_layer(*preview).primitives)), rows);
    EXPECT_EQ(test::difference(*preview, *whole), "");
  }
  EXPECT_EQ(preview_size(bytes, "a.ply", 0).value().bytes, 0u) << "too few for a preview";
}

TEST(SplatPreview, NeedsTheHeader) {
  const std::vector<std::byte> bytes = ply_with(3);
  const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::size_t body = text.find("end_header") + 11;
  for (std::size_t length = 0; length <= body; ++length) {
    EXPECT_EQ(preview_size(Bytes(bytes).first(length), "a.ply", 0).has_value(), length > body)
        << length;
    EXPECT_FALSE(read_preview(Bytes(bytes).first(length), "a.ply")) << length;
  }
  EXPECT_TRUE(preview_size(Bytes(bytes).first(body + 1), "a.ply", 0));
  const std::string comment =
      "ply\nformat binary_little_endian 1.0\ncomment end_header is not here\n";
  EXPECT_FALSE(preview_size(std::as_bytes(std::span(comment)), "a.ply", 0));
}

TEST(SplatPreview, OfRecordsIsKnownByName) {
  const std::vector<std::byte> bytes(splat_record_size * 5 + 7, std::byte(0x3f));
  EXPECT_EQ(preview_size(bytes, "a.splat", 0).value().bytes, splat_record_size * first_splats);
  EXPECT_EQ(count(std::get<Splats>(only_layer(*read_preview(bytes, "a.splat")).primitives)), 5u);
  const std::vector<std::byte> misnamed = ply_with(3);
  EXPECT_EQ(count(std::get<Splats>(only_layer(*read_preview(misnamed, "a.splat")).primitives)), 3u);
  EXPECT_EQ(preview_size(bytes, "a.spz", 0).value().bytes, 0u);
  EXPECT_FALSE(read_preview(bytes, "a.spz"));
}

TEST(SplatPreview, SurvivesDamage) {
  const std::vector<std::byte> bytes = ply_with(2);
  std::size_t shown = 0;
  const auto survival = test::survive_damage(bytes, [&](Bytes damaged) {
    const auto preview = read_preview(damaged, "a.ply");
    if (!preview) return;
    ++shown;
    EXPECT_FALSE(defect(std::get<Splats>(only_layer(*preview).primitives)));
  });
  EXPECT_GT(survival.refused, 0u);
  EXPECT_GT(shown, 0u);
}

}  // namespace splat_preview_test
}  // namespace tureen
