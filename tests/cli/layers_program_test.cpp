// Program tests of scenes with several layers: convert, info, render, and commands for one layer.
#include <gmock/gmock.h>

#include "formats/scene_file.hpp"
#include "formats/tureen_glb/tureen_glb.hpp"
#include "tests/cli/program_fixture.hpp"
#include "tests/support/errors.hpp"

namespace tureen {
namespace layers_program_test {

using test::ChildResult;
using test::Names;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

/// Two scenes, and a third with two layers of which one is rotated.
class LayersProgram : public test::Program {
 protected:
  void SetUp() override {
    test::Program::SetUp();
    write_scene();
    write("fox.off", "COFF\n3 1 0\n5 0 0\n6 0 0\n5 1 0\n3 0 1 2 0 255 0\n");
    Scene scene = read_scene(folder / "fox.off");
    scene.layers.push_back(scene.layers.front());
    scene.layers[1].name = "turned";
    scene.layers[1].world_from_layer = {{0, 2, 0, 0}, {-2, 0, 0, 0}, {0, 0, 2, 0}, {1e6, 0, 0, 1}};
    scene.layers[1].visible = false;
    write_scene_file("two.glb", scene);
    scene.layers.erase(scene.layers.begin());
    write_scene_file("turned.glb", scene);
  }
  void write_scene_file(const std::string& name, const Scene& scene) const {
    write_tureen_glb(scene, folder / name);
  }
  nlohmann::ordered_json info(std::vector<std::string> files) const {
    files.insert(files.begin(), "info");
    files.emplace_back("--json");
    const ChildResult result = run(files);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return nlohmann::ordered_json::parse(result.out);
  }
  void expect_usage_error(const std::vector<std::string>& arguments, const std::string& says) {
    const ChildResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_THAT(result.err, HasSubstr(says));
  }
};

TEST_F(LayersProgram, ConvertMakesEachSceneALayer) {
  const ChildResult result =
      run({"convert", "scene.off", "fox.off", "two.glb", "fox.off", "-o", "all.glb", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("Reading scene.off, fox.off, two.glb, fox.off:"));
  EXPECT_THAT(result.err, HasSubstr("fox: OFF stores no up axis"));
  EXPECT_EQ(nlohmann::json::parse(result.out)["remarks"][1]["scene"], "fox");
  const Scene scene = read_scene(folder / "all.glb");
  std::vector<std::string> names;
  for (const Layer& layer : scene.layers) names.push_back(layer.name);
  // two.glb was made from fox.off and has its name.
  EXPECT_THAT(names, ElementsAre("scene", "fox", "fox 2", "turned", "fox 3"));
  EXPECT_EQ(scene.info.name, "scene");
  EXPECT_FALSE(scene.layers[3].visible);
  EXPECT_EQ(scene.layers[3].world_from_layer,
            read_scene(folder / "two.glb").layers[1].world_from_layer);
}

TEST_F(LayersProgram, ConvertOfOneSceneIsAsBefore) {
  ASSERT_EQ(run({"convert", "scene.off", "a.glb"}).exit_code, 0);
  ASSERT_EQ(run({"convert", "scene.off", "-o", "b.glb"}).exit_code, 0);
  EXPECT_EQ(Input::open(folder / "a.glb").read_rest(), Input::open(folder / "b.glb").read_rest());
  EXPECT_EQ(only_layer(read_scene(folder / "a.glb")).name, "");
  EXPECT_FALSE(info({"a.glb"}).contains("layers"));
}

TEST_F(LayersProgram, ConvertStoresMaterials) {
  const ChildResult result = run({"convert", "scene.off", "fox.off", "-o", "all.glb", "--material",
                                  "fox=glass:1.33", "--material", "scene=mirror"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  Scene scene = read_scene(folder / "all.glb");
  EXPECT_EQ(scene.layers[0].material, mirror_material());
  EXPECT_EQ(scene.layers[1].material, glass_material(1.33f));
  ASSERT_EQ(run({"convert", "all.glb", "one.glb", "--layer", "fox"}).exit_code, 0);
  EXPECT_EQ(only_layer(read_scene(folder / "one.glb")).material, glass_material(1.33f));
  ASSERT_EQ(run({"convert", "all.glb", "same.glb", "--material", "fox=stored"}).exit_code, 0);
  EXPECT_EQ(read_scene(folder / "same.glb").layers[1].material, glass_material(1.33f));
  expect_usage_error({"convert", "scene.off", "no.glb", "--material", "wall=mirror"},
                     "the layers are: layer 1");
  expect_usage_error({"convert", "scene.off", "no.glb", "--material", "layer 1=gold"},
                     "mirror, glass and stored");
  expect_usage_error({"convert", "scene.off", "no.ply", "--material", "layer 1=mirror"},
                     "--material");
  expect_usage_error({"render", "all.glb", "-o", "no.png", "--material", "wall=mirror"},
                     "the layers are: scene, fox");
  for (const char* name : {"no.glb", "no.ply", "no.png"}) EXPECT_FALSE(exists(name));
}

TEST_F(LayersProgram, ConvertRefusesSeveralLayersWhereOneIsNeeded) {
  expect_usage_error({"convert", "scene.off"}, "OUT");
  expect_usage_error({"convert", "scene.off", "fox.off", "out.glb"}, "-o OUT");
  expect_usage_error({"convert", "scene.off", "fox.off", "-o", "fox.off", "--force"}, "fox.off");
  for (const std::string out : {"out.off", "out.ply", "out/"})
    expect_usage_error({"convert", "scene.off", "fox.off", "-o", out}, "has 2: scene, fox");
  expect_usage_error({"convert", "scene.off", "fox.off", "-o", "out.glb", "--lattice-level", "1"},
                     "has 2: scene, fox");
  expect_usage_error({"convert", "scene.off", "fox.off", "-o", "out.glb", "--compress"},
                     "has 2: scene, fox");
  for (const char* name : {"out.glb", "out.off", "out.ply", "out"}) EXPECT_FALSE(exists(name));
}

TEST_F(LayersProgram, ConvertAppliesTheTransformOfALayer) {
  const ChildResult result = run({"convert", "turned.glb", "turned.off"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("OFF holds no transform"));
  EXPECT_EQ(only_soup(read_scene(folder / "turned.off")).positions[0], glm::vec3(0, 10, 0));
}

TEST_F(LayersProgram, InfoListsEachLayer) {
  const ChildResult text = run({"info", "scene.off", "two.glb"});
  ASSERT_EQ(text.exit_code, 0) << text.err;
  EXPECT_THAT(text.err, HasSubstr("scene.off, two.glb: "));
  for (const char* heading : {"Layer scene:", "Plan of fox:", "Lint of turned:"})
    EXPECT_THAT(text.err, HasSubstr(heading));
  EXPECT_THAT(text.err,
              HasSubstr("at (1e+06, 0, 0), turned by (0, 0, 90) degrees about x, y and z, "
                        "2 times as large; hidden"));

  const auto json = info({"scene.off", "two.glb"});
  EXPECT_EQ(json["files"], nlohmann::ordered_json({"scene.off", "two.glb"}));
  EXPECT_EQ(json["triangles"], 5);
  EXPECT_EQ(json["vertices"], 10);
  EXPECT_FALSE(json.contains("lint"));
  ASSERT_EQ(json["layers"].size(), 3u);
  const auto& turned = json["layers"][2];
  EXPECT_THAT(keys(turned),
              ElementsAre("name", "visible", "world_from_layer", "triangles", "vertices",
                          "soft_triangles", "appearance", "bytes_in_memory", "bytes_on_device",
                          "plan", "specialisations", "lint"));
  EXPECT_EQ(turned["name"], "turned");
  EXPECT_EQ(turned["visible"], false);
  EXPECT_EQ(turned["world_from_layer"][12], 1e6);
  EXPECT_EQ(turned["lint"]["clean"], true);
  EXPECT_EQ(json["layers"][0]["lint"]["clean"], false);
  EXPECT_EQ(run({"info", "scene.off", "fox.off", "--strict"}).exit_code, 1);
  EXPECT_EQ(run({"info", "two.glb", "--strict"}).exit_code, 0);
}

TEST_F(LayersProgram, AGivenUpAxisIsNoAssumption) {
  EXPECT_THAT(run({"info", "fox.off"}).err, HasSubstr("stores no up axis"));
  EXPECT_THAT(run({"info", "fox.off", "--up", "0,1,0"}).err, Not(HasSubstr("stores no up axis")));
}

TEST_F(LayersProgram, ASecondSceneAsOutputReportsThatTheOptionIsMissing) {
  expect_usage_error({"convert", "scene.off", "two.glb"}, "-o OUT is missing");
  EXPECT_THAT(run({"convert", "scene.off", "-o", "two.glb"}).err, Not(HasSubstr("is missing")));
  write("text.off", "no scene");
  EXPECT_THAT(run({"convert", "scene.off", "text.off"}).err, Not(HasSubstr("is missing")));
}

TEST_F(LayersProgram, HiddenLayersAreReported) {
  const auto image = [&](const std::string& scene) {
    return run({"render", scene, "--size", "32x24", "--context", "osmesa", "-o", "image.png"}).err;
  };
  EXPECT_THAT(image("two.glb"), Not(HasSubstr("hidden:")));
  EXPECT_THAT(run({"info", "two.glb"}).err, Not(HasSubstr("hidden:")));
  EXPECT_THAT(image("turned.glb"), HasSubstr("The only layer is hidden:"));
  Scene scene = read_scene(folder / "two.glb");
  for (Layer& layer : scene.layers) layer.visible = false;
  write_scene_file("hidden.glb", scene);
  EXPECT_THAT(image("hidden.glb"), HasSubstr("All layers are hidden:"));
  EXPECT_THAT(run({"info", "hidden.glb"}).err, HasSubstr("All layers are hidden:"));
}

TEST_F(LayersProgram, ConvertExtractsALayer) {
  ASSERT_EQ(run({"convert", "two.glb", "--layer", "turned", "-o", "one.glb"}).exit_code, 0);
  const Scene scene = read_scene(folder / "one.glb");
  const Layer& layer = only_layer(scene);
  EXPECT_EQ(layer.name, "turned");
  EXPECT_TRUE(layer.visible);
  EXPECT_EQ(layer.world_from_layer, read_scene(folder / "two.glb").layers[1].world_from_layer);
  expect_usage_error({"convert", "two.glb", "--layer", "x", "-o", "no.glb"}, "layer 1, turned");
  expect_usage_error({"bench", "two.glb", "--rounds", "1"}, "--layer NAME");
}

TEST_F(LayersProgram, TheMemoryLimitIsForEachScene) {
  EXPECT_THAT(run({"info", "--help"}).out, HasSubstr("each scene or dataset"));
}

TEST_F(LayersProgram, InfoOfOneTurnedLayerNamesItsPlace) {
  const auto json = info({"turned.glb"});
  EXPECT_FALSE(json.contains("layers"));
  EXPECT_EQ(json["world_from_layer"][1], 2);
  EXPECT_THAT(run({"info", "turned.glb"}).err, HasSubstr("turned by (0, 0, 90) degrees"));
}

TEST_F(LayersProgram, CommandsForOneLayerNameTheLayers) {
  ASSERT_EQ(run({"convert", "scene.off", "fox.off", "-o", "all.glb"}).exit_code, 0);
  expect_usage_error({"bench", "all.glb", "--rounds", "1"}, "has 2: scene, fox");
  // Without support for its rotation, a layer whose colours depend on the view is refused.
  Scene scene = read_scene(std::filesystem::path(TUREEN_SOURCE_DIR) / "examples/soup.glb");
  scene.layers[0].world_from_layer[0][0] = -1;
  write_scene_file("mirrored.glb", scene);
  expect_usage_error({"bench", "mirrored.glb", "--rounds", "1"}, "mirrored");
  expect_usage_error({"convert", "mirrored.glb", "export/"}, "mirrored");
  expect_usage_error({"convert", "mirrored.glb", "c.glb", "--compress"}, "mirrored");
}

}  // namespace layers_program_test
}  // namespace tureen
