// Program tests of scenes with several layers: convert, info, render, and commands for one layer.
#include <gmock/gmock.h>

#include <glm/geometric.hpp>

#include "formats/scene_file.hpp"
#include "formats/tureen_glb/tureen_glb.hpp"
#include "tests/cli/program_fixture.hpp"
#include "tests/support/errors.hpp"

namespace tureen {
namespace layers_program_test {

using test::ChildResult;
using test::Names;
using testing::AllOf;
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
  // In world coordinates: the layer's origin is at (1e6, 0, 0).
  EXPECT_EQ(only_soup(read_scene(folder / "turned.off")).positions[0], glm::vec3(1e6f, 10, 0));
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

TEST_F(LayersProgram, ASecondSceneAsOutputReportsBothWaysOut) {
  expect_usage_error(
      {"convert", "scene.off", "two.glb"},
      "to write one scene from all of them, add -o OUT.glb; to replace two.glb, add");
  EXPECT_THAT(run({"convert", "scene.off", "-o", "two.glb"}).err, Not(HasSubstr("one scene")));
  write("text.off", "no scene");
  EXPECT_THAT(run({"convert", "scene.off", "text.off"}).err, Not(HasSubstr("one scene")));
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

TEST_F(LayersProgram, LayersArePlacedByName) {
  const ChildResult result =
      run({"convert", "scene.off", "two.glb", "-o", "placed.glb", "--place",
           "turned=at:1,2,3/turn:0,0,30/mirror/visible", "--place", "scene=scale:2/hidden"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  // The option has what info prints.
  EXPECT_THAT(run({"info", "placed.glb"}).err,
              AllOf(HasSubstr("at (1, 2, 3), turned by (0, 0, 30) degrees about x, y and z, "
                              "2 times as large, mirrored\n"),
                    HasSubstr("at (0, 0, 0), 2 times as large; hidden")));
  const auto image = [&](const std::string& scene, const std::string& place) {
    std::vector<std::string> arguments{"render",    scene,    "--size", "32x24",
                                       "--context", "osmesa", "-o",     scene + ".png"};
    if (!place.empty()) arguments.insert(arguments.end(), {"--place", place});
    const ChildResult drawn = run(arguments);
    EXPECT_EQ(drawn.exit_code, 0) << drawn.err;
    return read_png(scene + ".png").pixels;
  };
  ASSERT_EQ(run({"convert", "scene.off", "moved.glb", "--place", "layer 1=turn:0,0,90"}).exit_code,
            0);
  EXPECT_EQ(image("scene.off", "layer 1=turn:0,0,90"), image("moved.glb", ""));
  EXPECT_NE(image("scene.off", ""), image("moved.glb", ""));
  expect_usage_error({"render", "scene.off", "--place", "fox=hidden"}, "the layers are: layer 1");
  expect_usage_error({"render", "scene.off", "--place", "fox=up"}, "mirror:no, hidden or visible");
}

TEST_F(LayersProgram, ScenesAreTurnedUpright) {
  ASSERT_EQ(run({"convert", "fox.off", "lying.glb", "--up", "0,1,0"}).exit_code, 0);
  const ChildResult result = run({"convert", "scene.off", "lying.glb", "-o", "both.glb"});
  EXPECT_THAT(result.err, HasSubstr("fox: turned about the world's origin, so that its up axis, y, "
                                    "becomes that of the first scene, z; --keep-axes changes it"));
  const auto up_of = [&](const std::string& name) {
    return read_scene(folder / name).layers[1].world_from_layer * glm::dvec4(0, 1, 0, 0);
  };
  EXPECT_EQ(up_of("both.glb"), glm::dvec4(0, 0, 1, 0));
  ASSERT_EQ(run({"convert", "scene.off", "lying.glb", "-o", "kept.glb", "--keep-axes"}).exit_code,
            0);
  EXPECT_EQ(up_of("kept.glb"), glm::dvec4(0, 1, 0, 0));
}

TEST_F(LayersProgram, AWholeSceneIsMoved) {
  const auto first = [&](const std::vector<std::string>& options) {
    std::vector<std::string> arguments{"convert", "fox.off", "moved.ply", "--force"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const ChildResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return only_soup(read_scene(folder / "moved.ply")).positions[0];
  };
  EXPECT_EQ(first({}), glm::vec3(5, 0, 0));
  EXPECT_LT(glm::distance(first({"--translate", "1,2,3", "--rotate", "0,0,90", "--resize", "2"}),
                          glm::vec3(1, 12, 3)),
            1e-6f);
  // PLY stores no up axis: readers assume z, and the named axis becomes z.
  EXPECT_EQ(first({"--up", "1,0,0"}), glm::vec3(0, 0, 5));
  EXPECT_THAT(run({"convert", "fox.off", "up.ply", "--up", "1,0,0"}).err,
              HasSubstr("up.ply stores no up axis: x is turned to z, which readers assume"));
  EXPECT_EQ(first({"--up", "0,0,1"}), glm::vec3(5, 0, 0));
  ASSERT_EQ(run({"convert", "fox.off", "up.glb", "--up", "1,0,0"}).exit_code, 0);
  EXPECT_EQ(only_layer(read_scene(folder / "up.glb")).world_from_layer, glm::dmat4(1.0));
  expect_usage_error({"convert", "fox.off", "no.ply", "--resize", "0"}, "--resize");
}

TEST_F(LayersProgram, TheFirstViewIsStoredAndShown) {
  Scene scene = read_scene(folder / "scene.off");
  for (int i = 0; i < 2; ++i)
    scene.cameras.push_back(
        look_at({3.0 * i - 1, -4, 1}, {0, 0, 0}, {0, 0, 1}, 0.7, 40 + 8 * i, 30));
  write_scene_file("cameras.glb", scene);
  const auto size = [&](const std::vector<std::string>& options) {
    std::vector<std::string> arguments{"render", "cameras.glb", "--context", "osmesa"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    EXPECT_EQ(run(arguments).exit_code, 0);
    return read_png("out.png").width;
  };
  EXPECT_EQ(size({}), 40) << "the first camera: two are no capture";
  ASSERT_EQ(run({"convert", "cameras.glb", "first.glb", "--view", "1"}).exit_code, 0);
  EXPECT_EQ(read_scene(folder / "first.glb").first_view, scene.cameras[1]);
  ASSERT_EQ(run({"convert", "first.glb", "cameras.glb", "--force"}).exit_code, 0);
  EXPECT_EQ(size({}), 48);
  EXPECT_EQ(size({"--camera", "cameras.glb:0"}), 40);
  EXPECT_EQ(size({"--camera", "0"}), 40);
  expect_usage_error({"render", "cameras.glb", "--camera", "999"}, "from 0 to 1");
  ASSERT_EQ(run({"convert", "scene.off", "other.glb", "--view", "cameras.glb:0"}).exit_code, 0);
  EXPECT_EQ(read_scene(folder / "other.glb").first_view, scene.cameras[0]);
  expect_usage_error({"convert", "scene.off", "no.glb", "--view", "0"}, "the scene has none");
  expect_usage_error({"convert", "cameras.glb", "no.glb", "--view", "2"}, "from 0 to 1");
  expect_usage_error({"convert", "cameras.glb", "no.glb", "--view", "cameras.glb:all"}, "several");
  expect_usage_error({"convert", "cameras.glb", "no.ply", "--view", "1"}, "only .glb and .html");
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
  EXPECT_THAT(run({"info", "--help"}).out, HasSubstr("per scene or dataset"));
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
