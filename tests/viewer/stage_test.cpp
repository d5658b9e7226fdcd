// Scenes of several files, before they are on the device.
#include "viewer/scene/stage.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <random>

#include "base/error.hpp"
#include "formats/common/format_remarks.hpp"
#include "formats/scene_file.hpp"
#include "scene/lattice.hpp"

namespace tureen::viewer {
namespace stage_test {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::IsEmpty;

class Stages : public testing::Test {
 protected:
  Stages()
      : folder_(fs::path(testing::TempDir()) / "stages" /
                testing::UnitTest::GetInstance()->current_test_info()->name()) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }

  fs::path good(const std::string& name) const {
    std::ofstream(folder_ / name) << "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 9 9 9\n";
    return folder_ / name;
  }
  fs::path bad(const std::string& name) const {
    std::ofstream(folder_ / name) << "OFF\n1 1 0\n";
    return folder_ / name;
  }
  /// Records of 32 bytes, all the same.
  fs::path splats(const std::string& name, std::size_t count) const {
    std::string record(32, '\x7f');
    const float values[6] = {1, 2, 3, 0.1f, 0.1f, 0.1f};
    std::memcpy(record.data(), values, sizeof values);
    std::ofstream file(folder_ / name, std::ios::binary);
    for (std::size_t i = 0; i < count; ++i) file << record;
    return folder_ / name;
  }
  ReadRequest request(std::vector<fs::path> paths) {
    return {.paths = std::move(paths),
            .progress = [](double) {},
            .unreadable = [this](const fs::path& path,
                                 const std::string&) { unreadable_.push_back(path.filename()); }};
  }

  fs::path folder_;
  std::vector<fs::path> unreadable_;
};

std::vector<std::string> names(const SceneSource& source) {
  std::vector<std::string> result;
  for (const DocumentLayer& layer : source.document.layers) result.push_back(layer.name);
  return result;
}

TEST_F(Stages, FilesWithErrorsAreLeftOut) {
  const SceneSource source =
      read_source(request({bad("a.off"), good("b.off"), bad("c.off"), good("d.off")}));
  EXPECT_THAT(names(source), ElementsAre("b", "d"));
  EXPECT_THAT(unreadable_, ElementsAre("a.off", "c.off"));
  EXPECT_THAT(names(read_more(source, request({bad("e.off")}))), ElementsAre("b", "d"));
  EXPECT_THAT(unreadable_, ElementsAre("a.off", "c.off", "e.off"));
}

TEST_F(Stages, WithoutAGoodFileTheErrorIsThrown) {
  EXPECT_THROW(read_source(request({bad("a.off"), bad("b.off")})), InputError);
  EXPECT_THAT(unreadable_, ElementsAre("a.off"));
}

TEST_F(Stages, RemovedLayersDoNotCount) {
  const fs::path a = good("a.off"), b = good("b.off");
  SceneSource source = read_source(request({a, b, b}));
  EXPECT_THAT(names(source), ElementsAre("a", "b", "b 2"));
  source.document.layers.resize(1);
  EXPECT_THAT(source.paths(), ElementsAre(a));
  EXPECT_TRUE(source.is_as_read());
  source = read_more(source, request({b}));
  EXPECT_THAT(names(source), ElementsAre("a", "b"));
  EXPECT_EQ(source.scene->layers.size(), 2u);
  EXPECT_TRUE(source.is_as_read());
  // The first file keeps its cameras and settings, so that another scene is read without it.
  source.document.layers.erase(source.document.layers.begin());
  EXPECT_FALSE(source.is_as_read());
  const SceneSource before = source;
  source = read_again(before, request({}));
  keep_changes(source, before);
  EXPECT_THAT(names(source), ElementsAre("b"));
  EXPECT_THAT(source.paths(), ElementsAre(b));
}

TEST_F(Stages, PreviewsOfALargeFileGrowToAQuarterOfIt) {
  const fs::path path = splats("many.splat", std::size_t(1) << 19);
  std::vector<std::size_t> counts;
  for (std::uint64_t shown = 0; const auto preview = read_source_preview(path, shown);) {
    counts.push_back(primitive_count(preview->source.document.layers.front()));
    EXPECT_EQ(preview->bytes, counts.back() * 32);
    EXPECT_THAT(all_notes(preview->source.scene->info), IsEmpty());
    shown = preview->bytes;
  }
  EXPECT_THAT(counts, ElementsAre(1u << 14, 1u << 16));
}

TEST_F(Stages, ALargeSoupIsPreviewedOnceInMeanColours) {
  constexpr std::uint32_t faces = 4000, level = 5;  // random texels: 18 MB in PNG strips
  const std::uint32_t texels = lattice::texel_count(level);
  std::mt19937 random(1);
  LatticeTexture texture;
  std::vector<std::uint8_t> values(std::size_t(faces) * texels * LatticeTexture::channels);
  for (std::uint8_t& value : values) value = std::uint8_t(random() >> 24);
  texture.texels = std::move(values);
  TriangleSoup soup;
  for (std::uint32_t t = 0; t < faces; ++t) {
    texture.patches.push_back({t * texels, level});
    soup.triangles.emplace_back(3 * t, 3 * t + 1, 3 * t + 2);
    const float x = float(t);
    soup.positions.insert(soup.positions.end(), {{x, 0, 0}, {x + 1, 0, 0}, {x, 1, 0}});
  }
  soup.appearance = std::move(texture);
  Scene scene;
  scene.layers.push_back({.primitives = std::move(soup)});
  write_scene(scene, folder_ / "large.glb");
  const auto preview = read_source_preview(folder_ / "large.glb", 0);
  ASSERT_TRUE(preview);
  const TriangleSoup* shown = soup_of(preview->source.document.layers.front());
  ASSERT_TRUE(shown);
  EXPECT_EQ(shown->triangles.size(), faces);
  EXPECT_TRUE(std::holds_alternative<FaceColors>(shown->appearance));
  EXPECT_FALSE(read_source_preview(folder_ / "large.glb", preview->bytes));
}

TEST_F(Stages, SmallMissingAndOtherFilesHaveNoPreview) {
  EXPECT_FALSE(read_source_preview(splats("few.splat", 1000), 0));
  EXPECT_FALSE(read_source_preview(folder_ / "missing.splat", 0));
  EXPECT_FALSE(read_source_preview(folder_, 0));
  EXPECT_FALSE(read_source_preview(splats("other.glb", std::size_t(1) << 19), 0));
}

TEST(WindowNotes, NameTheControlsOfTheWindow) {
  SceneInfo info;
  info.notes = {"a note"};
  info.remarks = {{&remarks::up_unknown_to_format, {{"format", "OFF"}}}};
  EXPECT_THAT(window_notes(info),
              ElementsAre("a note", testing::AllOf(testing::HasSubstr("Up in the panel View"),
                                                   testing::Not(testing::HasSubstr("--up")))));
}

}  // namespace stage_test
}  // namespace tureen::viewer
