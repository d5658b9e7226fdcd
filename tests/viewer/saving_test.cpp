// A document is saved and read again.
#include "viewer/scene/saving.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <glm/gtc/matrix_transform.hpp>

#include "base/error.hpp"
#include "formats/scene_file.hpp"
#include "scene/document/place_text.hpp"
#include "tests/support/random_soups.hpp"
#include "tests/support/random_splats.hpp"
#include "viewer/render_command.hpp"

namespace tureen::viewer {
namespace saving_test {

namespace fs = std::filesystem;
using testing::IsEmpty;
using testing::SizeIs;

class Saving : public testing::Test {
 protected:
  Saving()
      : folder_(fs::path(testing::TempDir()) / "saving" /
                testing::UnitTest::GetInstance()->current_test_info()->name()) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  SceneSource read(const std::vector<std::string>& names) const {
    ReadRequest request{.paths = {}, .progress = [](double) {}};
    for (const std::string& name : names) request.paths.push_back(folder_ / name);
    return read_source(request);
  }
  /// A soup and splats, each in a file.
  SceneSource two_files() const {
    write_scene(scene_of(test::random_soup(1, {.kind = test::Kind::lattice})),
                folder_ / "soup.glb");
    write_scene(scene_of(test::random_splats(test::splat_kinds[1], 50, 0.1, 2)),
                folder_ / "splats.ply");
    return read({"soup.glb", "splats.ply"});
  }
  fs::path folder_;
};

Edit moved(const SceneSource& source, std::size_t layer) {
  return PlaceLayer{source.document.layers[layer].id,
                    glm::rotate(at_origin({1, 2, 3}), 0.4, glm::dvec3(0, 0, 1))};
}

TEST_F(Saving, ReportsProgressAndCanBeCancelled) {
  const SceneSource source = two_files();
  const fs::path file = folder_ / "both.glb";
  std::vector<double> reported;
  save_scene(source, file, false, [&](double done) { reported.push_back(done); });
  EXPECT_THAT(reported, SizeIs(testing::Ge(3)));
  EXPECT_TRUE(std::is_sorted(reported.begin(), reported.end()));
  EXPECT_GT(reported.front(), 0);
  EXPECT_NEAR(reported.back(), 1, 0.01) << "all but the last bytes of padding";
  const auto size = fs::file_size(file);
  SceneSource changed = source;
  apply_edit(changed.document, RemoveLayers{{source.document.layers[0].id}});
  for (std::size_t calls = 0; calls < 2; ++calls) {
    std::size_t left = calls;
    const auto cancel = [&](double) {
      if (left-- == 0) throw std::runtime_error("cancelled");
    };
    EXPECT_THROW(save_scene(changed, file, false, cancel), std::runtime_error);
    EXPECT_EQ(fs::file_size(file), size) << "the old file stays";
  }
  EXPECT_THROW(save_scene(changed, folder_ / "new.ply", true, [](double) { throw 1; }), int)
      << "also in a format that reports nothing";
  for (const auto& each : fs::directory_iterator(folder_))
    EXPECT_THAT(each.path().extension(), testing::AnyOf(".glb", ".ply")) << each.path();
  EXPECT_FALSE(fs::exists(folder_ / "new.ply"));
}

TEST_F(Saving, AGlbHoldsTheDocument) {
  SceneSource source = two_files();
  Document& document = source.document;
  const LayerId soup = document.layers[0].id;
  for (const Edit& edit :
       {moved(source, 1), Edit(ShowLayer{soup, false}), Edit(RenameLayer{soup, "house"}),
        Edit(ReorderLayer{soup, 1}), Edit(SetMaterial{soup, glass_material(1.33f)}),
        Edit(ChangeUp{{0, 0, 1}}), Edit(ChangeQuality{{.supersampling = 2}}),
        Edit(ChangeProfile{profile_named("mip")}), Edit(ChangeBackground{glm::vec3(0.25, 0.5, 1)}),
        Edit(ChangeFirstView{look_at({1, 2, 3}, {0, 0, 0}, {0, 0, 1}, 0.7, 320, 200)})})
    apply_edit(document, edit);
  EXPECT_FALSE(source.is_as_read());
  Saved saved = save_scene(source, folder_ / "both.glb", false);
  EXPECT_TRUE(saved.is_written);
  EXPECT_THAT(saved.lost, IsEmpty());
  const SceneSource again = read({"both.glb"});
  ASSERT_THAT(again.document.layers, SizeIs(2));
  for (std::size_t i = 0; i < 2; ++i) {
    const DocumentLayer &before = document.layers[i], &after = again.document.layers[i];
    EXPECT_EQ(after.name, before.name);
    EXPECT_EQ(after.visible, before.visible);
    EXPECT_EQ(after.world_from_layer, before.world_from_layer);
    EXPECT_EQ(after.material, before.material);
    EXPECT_EQ(primitive_count(after), primitive_count(before));
  }
  EXPECT_EQ(again.document.up, document.up);
  EXPECT_EQ(again.document.quality, document.quality);
  EXPECT_EQ(background_of(again), background_of(source));
  ASSERT_TRUE(first_view_of(again));
  EXPECT_LT(glm::distance(first_view_of(again)->eye(), glm::dvec3(1, 2, 3)), 1e-9);
  EXPECT_EQ(splats_of(again.document.layers[0])->profile, *document.profile);
  // The window then has this file, with the layers that it had.
  const SceneSource snapshot = source;
  adopt_file(source, snapshot, saved.file);
  EXPECT_TRUE(source.is_as_read());
  EXPECT_EQ(source.paths(), std::vector{folder_ / "both.glb"});
  EXPECT_TRUE(can_be_replaced(source.files.front()));
  SceneSource reread = read_again(source, {.paths = {}, .progress = [](double) {}});
  keep_changes(reread, source);
  EXPECT_TRUE(reread.is_as_read());
  EXPECT_EQ(reread.document.layers[1].id, soup);
}

// A material alone is a change, and it outlives reading the file again.
TEST_F(Saving, AMaterialIsAChange) {
  two_files();
  SceneSource source = read({"soup.glb"});
  EXPECT_TRUE(source.is_as_read());
  apply_edit(source.document, SetMaterial{source.document.layers[0].id, mirror_material()});
  EXPECT_FALSE(source.is_as_read());
  SceneSource reread = read_again(source, {.paths = {}, .progress = [](double) {}});
  keep_changes(reread, source);
  EXPECT_EQ(reread.document.layers[0].material, mirror_material());
  save_scene(source, folder_ / "mirror.glb", false);
  EXPECT_EQ(read({"mirror.glb"}).document.layers[0].material, mirror_material());
}

/// What the copied command reads is what the window shows.
TEST_F(Saving, PlaceArgumentsGiveTheDocument) {
  SceneSource source = two_files();
  EXPECT_THAT(place_arguments(source), IsEmpty());
  // The soup's up axis is y, the splats' is -y: they were turned, as the command turns them.
  EXPECT_NE(source.document.layers[1].world_from_layer, glm::dmat4(1.0));
  const auto check = [&](const std::vector<std::string>& files, std::vector<bool> visible) {
    std::vector<Scene> scenes;
    for (const std::string& file : files) {
      scenes.push_back(read_scene(folder_ / file));
      scenes.back().info.name = fs::path(file).stem().string();
    }
    Scene scene = merged(std::move(scenes));
    std::vector<PlaceChange> changes;
    const std::vector<std::string> arguments = place_arguments(source);
    for (std::size_t i = 1; i < arguments.size(); i += 2) {
      EXPECT_EQ(arguments[i - 1], "--place");
      changes.push_back(parse_place(arguments[i]));
    }
    place_layers(scene, changes);
    ASSERT_EQ(scene.layers.size(), visible.size());
    for (std::size_t i = 0; i < visible.size(); ++i)
      EXPECT_EQ(scene.layers[i].visible, visible[i]) << i;
    const glm::dmat4& shown = source.document.layers.back().world_from_layer;
    for (int column = 0; column < 4; ++column)  // angles and back: rounding
      EXPECT_LT(glm::distance(scene.layers.back().world_from_layer[column], shown[column]), 1e-12);
  };
  apply_edit(source.document, moved(source, 1));
  apply_edit(source.document, ShowLayer{source.document.layers[0].id, false});
  check({"soup.glb", "splats.ply"}, {false, true});
  // The first file is no longer read: the second is not turned for it.
  apply_edit(source.document, RemoveLayers{{source.document.layers[0].id}});
  check({"splats.ply"}, {true});
}

TEST_F(Saving, ASingleLayerWithoutANameStaysOne) {
  two_files();
  SceneSource source = read({"soup.glb"});
  save_scene(source, folder_ / "copy.glb", false);
  EXPECT_EQ(read_scene(folder_ / "copy.glb").layers.front().name, "");
  apply_edit(source.document, RenameLayer{source.document.layers[0].id, "house"});
  save_scene(source, folder_ / "copy.glb", false);
  EXPECT_EQ(read_scene(folder_ / "copy.glb").layers.front().name, "house");
}

TEST_F(Saving, WhatAFormatLosesIsSaidBefore) {
  two_files();
  const SceneSource source = read({"soup.glb"});  // textures, which OFF lacks
  std::ofstream(folder_ / "soup.off") << "old";
  Saved saved = save_scene(source, folder_ / "soup.off", false);
  EXPECT_FALSE(saved.is_written);
  EXPECT_THAT(saved.lost, testing::Not(IsEmpty()));
  EXPECT_EQ(fs::file_size(folder_ / "soup.off"), 3u);
  saved = save_scene(source, folder_ / "soup.off", true);
  EXPECT_TRUE(saved.is_written);
  EXPECT_GT(fs::file_size(folder_ / "soup.off"), 100u);
  for (const auto& file : fs::directory_iterator(folder_))
    EXPECT_THAT(file.path().filename().string(),
                testing::AnyOf("soup.glb", "splats.ply", "soup.off"));
}

TEST_F(Saving, AFormatThatHoldsTheSceneIsWrittenAtOnce) {
  two_files();
  SceneSource source = read({"splats.ply"});
  const SceneSource before = source;
  Saved saved = save_scene(source, folder_ / "copy.ply", false);
  EXPECT_TRUE(saved.is_written);
  adopt_file(source, before, saved.file);
  EXPECT_FALSE(source.is_as_read()) << "its layers are in memory";
  SceneSource reread = read_again(source, {.paths = {}, .progress = [](double) {}});
  keep_changes(reread, source);
  EXPECT_EQ(reread.document.layers[0].primitives, source.document.layers[0].primitives);
}

TEST_F(Saving, OnlyGlbHoldsSeveralLayers) {
  EXPECT_THROW(save_scene(two_files(), folder_ / "both.ply", true), UsageError);
}

TEST_F(Saving, ForeignFilesAreNotReplaced) {
  SceneSource source = two_files();
  EXPECT_TRUE(can_be_replaced(source.files[0]));
  EXPECT_TRUE(can_be_replaced(source.files[1]));
  source.files[0].path = folder_ / "foreign.glb";
  std::ofstream(folder_ / "foreign.glb") << "glTF, it says";
  EXPECT_FALSE(can_be_replaced(source.files[0]));
  EXPECT_EQ(proposed_file(source), folder_ / "foreign-2.glb");
  EXPECT_THAT(name_defect(source, folder_ / "a.fbx"), testing::HasSubstr(".fbx"));
  EXPECT_THAT(name_defect(source, folder_ / "none" / "a.glb"), testing::HasSubstr("no folder"));
  EXPECT_NE(name_defect(source, folder_ / "a"), "");
  EXPECT_EQ(name_defect(source, folder_ / "a.glb"), "");
}

TEST_F(Saving, AKilledProgramLeavesTheOldFileOrTheNewOne) {
  SceneSource source = two_files();
  save_scene(source, folder_ / "saved.glb", false);
  for (int milliseconds = 0; milliseconds < 20; ++milliseconds) {
    const pid_t child = ::fork();
    if (child == 0) {
      for (int i = 0;; ++i) {
        apply_edit(source.document, RenameLayer{source.document.layers[0].id, std::to_string(i)});
        save_scene(source, folder_ / "saved.glb", false);
      }
    }
    ::usleep(useconds_t(1000 * milliseconds));
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    EXPECT_EQ(read_scene(folder_ / "saved.glb").layers.size(), 2u);
  }
}

}  // namespace saving_test
}  // namespace tureen::viewer
