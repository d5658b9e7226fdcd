// Several scenes as one: layers, names, remarks, and the settings of the first.
#include <gmock/gmock.h>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "base/error.hpp"
#include "formats/common/format_remarks.hpp"
#include "formats/mesh/mesh_remarks.hpp"
#include "scene/edit/moved_scene.hpp"
#include "scene/scene.hpp"
#include "scene/scene_remarks.hpp"
#include "scene/similarity.hpp"

namespace tureen {
namespace merged_test {

using testing::ElementsAre;
using testing::HasSubstr;

TriangleSoup one_triangle(float x) {
  return {.positions = {{x, 0, 0}, {1, 0, 0}, {0, 2, 3}},
          .triangles = {{0, 1, 2}},
          .appearance = FaceColors{{glm::vec4(1)}}};
}

Scene scene_named(const std::string& name, float x = 0) {
  Scene scene = scene_of(one_triangle(x), {x, 0, 0});
  scene.info.name = name;
  return scene;
}

std::vector<std::string> layer_names_of(const Scene& scene) {
  std::vector<std::string> names;
  for (const Layer& layer : scene.layers) names.push_back(layer.name);
  return names;
}

TEST(Merged, OneSceneStaysAsItIs) {
  Scene scene = scene_named("fox");
  scene.info.notes = {"a note"};
  const Scene result = merged({scene});
  EXPECT_EQ(result.layers.at(0).name, "");
  EXPECT_THAT(result.info.notes, ElementsAre("a note"));
}

TEST(Merged, LayersKeepTheirOrderAndPlace) {
  const Scene result = merged({scene_named("a", 1), scene_named("b", 2), scene_named("c", 3)});
  ASSERT_EQ(result.layers.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    const Layer& layer = result.layers[i];
    EXPECT_EQ(origin_of(layer), glm::dvec3(double(i + 1), 0, 0));
    EXPECT_EQ(std::get<TriangleSoup>(layer.primitives).positions[0].x, float(i + 1));
  }
}

TEST(Merged, NamesAreDistinct) {
  Scene several = scene_named("house");
  several.layers.push_back({.name = "fox", .primitives = one_triangle(0)});
  several.layers.push_back({.primitives = one_triangle(0)});
  EXPECT_THAT(layer_names_of(merged({scene_named("fox"), several, scene_named("fox"),
                                     scene_named("fox 2"), scene_named("")})),
              ElementsAre("fox", "house", "fox 2", "house 2", "fox 2 2", "fox 2 2 2", "scene"));
}

TEST(Merged, SettingsAreThoseOfTheFirstScene) {
  Scene first = scene_named("first"), second = scene_named("second");
  first.info.up = {0, 0, 1};
  first.info.background = glm::vec3(1);
  first.info.source = "by hand";
  first.quality.supersampling = 2;
  second.cameras.resize(2);
  second.info.compressed = true;
  const Scene result = merged({first, second, first}, UpAxes::keep);
  EXPECT_EQ(result.info.name, "first");
  EXPECT_EQ(result.info.source, "by hand");
  EXPECT_EQ(result.info.up, glm::vec3(0, 0, 1));
  EXPECT_EQ(result.info.background, glm::vec3(1));
  EXPECT_EQ(result.quality.supersampling, 2);
  EXPECT_TRUE(result.cameras.empty());
  EXPECT_TRUE(result.info.compressed);
  ASSERT_EQ(result.info.remarks.size(), 1u);
  EXPECT_EQ(result.info.remarks[0],
            (Remark{.kind = &remarks::settings_dropped,
                    .fields = {{"settings", std::vector<std::string>{"cameras", "up axis",
                                                                     "background", "quality"}}},
                    .scene = "second"}));
  EXPECT_EQ(describe(result.info.remarks[0]),
            "second: these settings differ from those of the first scene and are ignored: cameras, "
            "up axis, background, quality");
  // Equal settings are not dropped.
  EXPECT_TRUE(merged({second, second}).info.remarks.empty());
}

TEST(Merged, FurtherScenesAreTurnedUpright) {
  Scene first = scene_named("first"), second = scene_named("second", 1);
  first.info.up = {0, 0, 1};
  second.info.up = {0, -1, 0};
  second.info.up_is_assumed = true;
  second.info.remarks = {{&remarks::up_unknown_to_format, {{"format", "PLY"}}}};
  first.first_view = Camera{.name = "first view"};
  const Scene result = merged({first, second});
  EXPECT_EQ(result.first_view, first.first_view);
  // The smallest rotation takes -y to z, and keeps x.
  const glm::dmat4& place = result.layers[1].world_from_layer;
  EXPECT_EQ(place * glm::dvec4(0, -1, 0, 0), glm::dvec4(0, 0, 1, 0));
  EXPECT_EQ(place * glm::dvec4(1, 0, 0, 0), glm::dvec4(1, 0, 0, 0));
  ASSERT_EQ(result.info.remarks.size(), 1u);
  EXPECT_EQ(describe(result.info.remarks[0]),
            "second: turned about the world's origin, so that its up axis, -y, becomes that of the "
            "first scene, z");
  const Scene kept = merged({first, second}, UpAxes::keep);
  EXPECT_EQ(kept.layers[1].world_from_layer, second.layers[0].world_from_layer);
}

TEST(Merged, RotationsBetweenAxesAreTheSmallest) {
  const glm::dvec3 axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.6, -0.8, 0}, {1e-9, 0, -1}};
  for (const glm::dvec3& from : axes)
    for (const glm::dvec3& to : axes)
      for (const double sign : {1.0, -1.0}) {
        const glm::dmat3 turn = rotation_between(2.0 * from, 3 * sign * to);
        // Between nearly opposite axes, the formula loses half of the digits.
        EXPECT_LT(glm::distance(turn * from, sign * to), 1e-7);
        EXPECT_NEAR(glm::determinant(turn), 1, 1e-7);
        const double cosine = 0.5 * (turn[0][0] + turn[1][1] + turn[2][2] - 1);
        EXPECT_NEAR(cosine, sign * glm::dot(from, to), 1e-7) << "turns no farther than it must";
      }
}

TEST(Merged, AMovedSceneLooksTheSameFromItsCameras) {
  Scene scene = scene_named("moved", 1);
  scene.cameras = {look_at({3, 1, 2}, {0, 0, 0}, {0, 0, 1}, 1, 64, 48)};
  scene.first_view = scene.cameras[0];
  const glm::dvec3 before(scene.cameras[0].view_from_world *
                          (scene.layers[0].world_from_layer * glm::dvec4(0.1, 0.2, 0.3, 1)));
  for (const bool mirror : {false, true}) {
    Scene moved = scene;
    move_scene(
        moved,
        matrix_of({.position = {1, 2, 3}, .angles = {10, 20, 30}, .scale = 2, .mirror = mirror}));
    for (const Camera& camera : {moved.cameras[0], *moved.first_view}) {
      const glm::dvec3 after(camera.view_from_world *
                             (moved.layers[0].world_from_layer * glm::dvec4(0.1, 0.2, 0.3, 1)));
      EXPECT_LT(glm::distance(after, 2.0 * before * glm::dvec3(mirror ? -1 : 1, 1, 1)), 1e-12);
      EXPECT_NEAR(glm::determinant(camera.world_from_view_rotation()), 1, 1e-12);
    }
  }
}

TEST(Merged, RemarksAndNotesNameTheirScene) {
  Scene one = scene_named("one"), two = scene_named("two");
  one.info.remarks = {{&remarks::colors_missing}};
  two.info.remarks = {{&remarks::polygons_split, {{"polygons", 3}}}};
  two.info.notes = {"a note"};
  const Scene result = merged({one, two});
  EXPECT_EQ(result.info.remarks,
            (std::vector<Remark>{
                {.kind = &remarks::colors_missing, .scene = "one"},
                {.kind = &remarks::polygons_split, .fields = {{"polygons", 3}}, .scene = "two"}}));
  EXPECT_THAT(result.info.notes, ElementsAre("two: a note"));
  // A scene that was merged before keeps the names.
  EXPECT_EQ(merged({result, two}).info.remarks.front().scene, "one");
}

TEST(Merged, NotesOfMergedScenesKeepTheirNames) {
  Scene one = scene_named("one"), two = scene_named("two");
  one.info.notes = {"a note"};
  two.info.notes = {"b"};
  Scene both = merged({one, two});
  both.info.notes.push_back("one: b");
  EXPECT_THAT(merged({both, scene_named("three"), both}).info.notes,
              ElementsAre("one: a note", "two: b", "one: b"));
}

TEST(Merged, OneLayerCanBeKept) {
  Scene scene = merged({scene_named("a", 1), scene_named("b", 2), scene_named("c", 3)});
  scene.layers[1].visible = false;
  EXPECT_TRUE(has_visible_layer(scene));
  Scene same = scene;
  same.layers[2].name = "b";
  EXPECT_THROW(keep_layer(same, "b"), UsageError) << "two have this name";
  same.layers[2].name = "";
  keep_layer(same, "layer 3");
  EXPECT_EQ(origin_of(only_layer(same)), glm::dvec3(3, 0, 0));
  try {
    keep_layer(scene, "d");
    FAIL() << "an unknown layer was accepted";
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), HasSubstr("a, b, c"));
  }
  Scene hidden = scene;
  for (Layer& layer : hidden.layers) layer.visible = false;
  EXPECT_FALSE(has_visible_layer(hidden));
  keep_layer(scene, "b");
  EXPECT_EQ(layer_names_of(scene), std::vector<std::string>{"b"});
  EXPECT_EQ(origin_of(scene.layers[0]), glm::dvec3(2, 0, 0));
  EXPECT_TRUE(scene.layers[0].visible);
}

TEST(Merged, MoreLayersThanTheStencilBufferCountsAreRefused) {
  const Scene one = scene_named("one");
  EXPECT_EQ(merged(std::vector<Scene>(max_layers, one)).layers.size(), 255u);
  try {
    merged(std::vector<Scene>(max_layers + 1, one));
    FAIL() << "256 layers were accepted";
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), HasSubstr("256 layers"));
    EXPECT_THAT(error.what(), HasSubstr("at most 255"));
  }
}

}  // namespace merged_test
}  // namespace tureen
