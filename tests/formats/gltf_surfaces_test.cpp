// Normals, mirrors and glass of foreign glTF, and in our own GLB.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "formats/gltf/gltf_remarks.hpp"
#include "formats/gltf_file.hpp"
#include "formats/tureen_glb/tureen_glb.hpp"
#include "tests/formats/glb_builder.hpp"
#include "tests/formats/tureen_glb/tureen_glb_kinds.hpp"
#include "tests/support/errors.hpp"

namespace tureen {
namespace gltf_surfaces_test {

using nlohmann::json;
using test::error_of;
using test::ErrorIn;
using test::GlbBuilder;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::Not;

Scene read_bytes(std::span<const std::byte> bytes) {
  Input input = Input::memory("scene.glb", bytes);
  return read_gltf_or_glb(input, {});
}
Scene read(const GlbBuilder& builder) { return read_bytes(builder.glb()); }

const TriangleSoup& soup_of(const Scene& scene, std::size_t layer) {
  return std::get<TriangleSoup>(scene.layers.at(layer).primitives);
}

/// The message of the first remark of this kind; "": there is none.
std::string remark_text(const Scene& scene, const RemarkKind& kind) {
  for (const Remark& remark : scene.info.remarks)
    if (remark.kind == &kind) return describe(remark);
  return "";
}

const json mirror = {{"name", "chrome"},
                     {"pbrMetallicRoughness", {{"metallicFactor", 1}, {"roughnessFactor", 0.1}}}};
const json glass = {
    {"name", "ball"},
    {"pbrMetallicRoughness",
     {{"metallicFactor", 0}, {"roughnessFactor", 0}, {"baseColorFactor", {1, 0.2140411, 0, 1}}}},
    {"extensions",
     {{"KHR_materials_transmission", {{"transmissionFactor", 0.9}}},
      {"KHR_materials_ior", {{"ior", 1.33}}}}}};

/// A triangle for each material; -1 for none.
GlbBuilder triangles(std::initializer_list<json> materials) {
  GlbBuilder b;
  for (const json& material : materials) {
    const int index = material.is_null() ? -1 : b.material(material);
    json& primitive = b.triangle();
    primitive["attributes"]["NORMAL"] = b.floats({0, 0, 1, 0, 0, 1, 0, 0, 1}, 3);
    if (index >= 0) primitive["material"] = index;
  }
  return b;
}

TEST(GltfNormals, MoveWithTheSurfaceAndBecomeUnit) {
  GlbBuilder b;
  auto& primitive = b.triangle();
  // Of length 1, 5 and 0.
  primitive["attributes"]["NORMAL"] = b.floats({0, 0, 1, 0, 3, 4, 0, 0, 0}, 3);
  EXPECT_THAT(only_soup(read(b)).normals,
              ElementsAre(glm::vec3(0, 0, 1), glm::vec3(0, 0.6f, 0.8f), glm::vec3(0)));
  // Stretched by (1, 2, 1): a plane with the normal (0, 3, 4) contains (0, 4, -3), then (0, 8, -3).
  b.document["nodes"][0]["scale"] = {1, 2, 1};
  const glm::vec3 stretched = only_soup(read(b)).normals[1];
  EXPECT_NEAR(glm::dot(stretched, glm::vec3(0, 8, -3)), 0, 1e-6);  // float rounding
  EXPECT_NEAR(glm::length(stretched), 1, 1e-6);
  // A mirror leaves it on its side: z = 0 swaps, and so does the normal along z.
  b.document["nodes"][0]["scale"] = {1, 1, -1};
  EXPECT_THAT(only_soup(read(b)).normals,
              ElementsAre(glm::vec3(0, 0, -1), glm::vec3(0, 0.6f, -0.8f), glm::vec3(0)));
  // A flattened surface has no normals left.
  b.document["nodes"][0]["scale"] = {1, 0, 1};
  EXPECT_THAT(only_soup(read(b)).normals, ::testing::Each(glm::vec3(0)));
}

TEST(GltfNormals, AreQuantisedAndMissingInSomePrimitives) {
  GlbBuilder b;
  b.triangle();
  auto& second = b.triangle();
  second["attributes"]["NORMAL"] =
      b.accessor(std::vector<std::int8_t>{127, 0, 0, 0, -127, 0, 0, 0, 64}, "VEC3", 5120, 3, true);
  b.triangle();
  const Scene scene = read(b);
  EXPECT_THAT(
      only_soup(scene).normals,
      ElementsAre(glm::vec3(0), glm::vec3(0), glm::vec3(0), glm::vec3(1, 0, 0), glm::vec3(0, -1, 0),
                  glm::vec3(0, 0, 1), glm::vec3(0), glm::vec3(0), glm::vec3(0)));
  GlbBuilder none;
  none.triangle();
  EXPECT_TRUE(only_soup(read(none)).normals.empty());
}

TEST(GltfNormals, ThatDoNotFitAreAnError) {
  GlbBuilder b;
  b.triangle()["attributes"]["NORMAL"] = b.floats({0, 0, 1, 0, 0, 1}, 3);
  EXPECT_THAT(error_of([&] { read(b); }), ErrorIn("scene.glb", "attributes.NORMAL", "POSITION"));
  GlbBuilder pairs;
  pairs.triangle()["attributes"]["NORMAL"] = pairs.floats({0, 0, 1, 0, 0, 1}, 2);
  EXPECT_THAT(error_of([&] { read(pairs); }), ErrorIn("scene.glb", "accessors[0]"));
}

TEST(GltfSurfaces, OfMirrorsAndGlassAreLayers) {
  GlbBuilder file = triangles({nullptr, mirror, glass, mirror});
  file.document["extensionsRequired"] = {"KHR_materials_transmission", "KHR_materials_ior"};
  const Scene scene = read(file);
  ASSERT_EQ(scene.layers.size(), 3u);
  EXPECT_EQ(scene.layers[0].material, std::nullopt);
  EXPECT_EQ(scene.layers[1].name, "chrome");
  EXPECT_EQ(soup_of(scene, 1).triangles.size(), 2u) << "equal materials are one layer";
  EXPECT_EQ(scene.layers[1].material, (Material{.metallic = 1.0f, .roughness = 0.1f}));
  EXPECT_EQ(scene.layers[2].name, "ball");
  ASSERT_TRUE(scene.layers[2].material);
  const Material& ball = *scene.layers[2].material;
  EXPECT_TRUE(is_glass(ball));
  EXPECT_EQ(ball.transmission, 0.9f);
  EXPECT_EQ(ball.ior, 1.33f);
  // 0.2140411 in linear light is 0.5 display-referred (IEC 61966-2-1), to its seven digits.
  EXPECT_NEAR(ball.base_color.g, 0.5f, 1e-6);
  EXPECT_EQ(ball.base_color.b, 0.0f);
  EXPECT_EQ(remark_text(scene, remarks::surfaces_split),
            "the materials chrome and ball are mirrors or glass: each is a layer of its own, and "
            "only rays show more than its base colour");
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_EQ(soup_of(scene, i).normals.size(), soup_of(scene, i).positions.size());
}

TEST(GltfSurfaces, ThatAreTheOnlyOneNeedNoName) {
  const Scene scene = read(triangles({mirror}));
  EXPECT_EQ(only_layer(scene).name, "");
  EXPECT_TRUE(is_mirror(*only_layer(scene).material));
}

TEST(GltfSurfaces, OfTheSameNameGetNumbers) {
  json second = mirror, third = mirror, fourth = mirror;
  second["pbrMetallicRoughness"]["roughnessFactor"] = 0;
  third["pbrMetallicRoughness"]["roughnessFactor"] = 0.05;
  fourth["pbrMetallicRoughness"]["roughnessFactor"] = 0.01;
  third.erase("name");
  const Scene scene = read(triangles({mirror, second, third, fourth}));
  std::vector<std::string> names;
  for (const Layer& layer : scene.layers) names.push_back(layer.name);
  EXPECT_THAT(names, ElementsAre("chrome", "chrome 2", "mirror", "chrome 3"));
}

// Every other material is drawn as before.
TEST(GltfSurfaces, AreOnlySmoothMetalsAndTransmission) {
  const auto is_surface = [](const json& base, const std::function<void(json&)>& change) {
    json material = base;
    change(material);
    const Scene scene = read(triangles({nullptr, material}));
    return scene.layers.size() > 1;
  };
  EXPECT_TRUE(is_surface(mirror, [](json&) {}));
  EXPECT_TRUE(is_surface(glass, [](json&) {}));
  const auto pbr = [](const char* key, double value) {
    return [=](json& material) { material["pbrMetallicRoughness"][key] = value; };
  };
  EXPECT_FALSE(is_surface(mirror, pbr("roughnessFactor", 0.11)));
  EXPECT_FALSE(is_surface(mirror, pbr("metallicFactor", 0.49)));
  EXPECT_FALSE(is_surface(glass, pbr("roughnessFactor", 0.11)));
  EXPECT_FALSE(is_surface(glass, [](json& m) {
    m["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 0.49;
  }));
  EXPECT_FALSE(
      is_surface(mirror, [](json& m) { m["extensions"]["KHR_materials_unlit"] = json::object(); }));
  EXPECT_FALSE(is_surface(json::object(), [](json&) {})) << "glTF's default is rough";
}

TEST(GltfSurfaces, WithValuesOutsideTheirRangesAreDrawnByTheirColour) {
  const auto reason = [](json material, const std::function<void(json&)>& change) {
    change(material);
    const Scene scene = read(triangles({material}));
    EXPECT_FALSE(only_layer(scene).material);
    return remark_text(scene, remarks::surface_dropped);
  };
  EXPECT_THAT(reason(mirror, [](json& m) { m["pbrMetallicRoughness"]["metallicFactor"] = 7; }),
              ::testing::AllOf(::testing::HasSubstr("materials[0]"),
                               ::testing::HasSubstr("metallic factor is outside 0..1")));
  EXPECT_THAT(reason(mirror, [](json& m) { m["pbrMetallicRoughness"]["roughnessFactor"] = -1; }),
              ::testing::HasSubstr("roughness is outside"));
  EXPECT_THAT(reason(glass, [](json& m) { m["extensions"]["KHR_materials_ior"]["ior"] = 0; }),
              ::testing::HasSubstr("index of refraction"));
  EXPECT_THAT(reason(glass,
                     [](json& m) {
                       m["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 1e30;
                     }),
              ::testing::HasSubstr("transmission is outside"));
  EXPECT_THAT(
      reason(
          glass,
          [](json& m) {
            m["extensions"]["KHR_materials_transmission"]["transmissionTexture"] = {{"index", 0}};
          }),
      ::testing::HasSubstr("texture"));
  GlbBuilder wrong = triangles({glass});
  wrong.document["materials"][0]["extensions"]["KHR_materials_ior"]["ior"] = "thick";
  EXPECT_THAT(error_of([&] { read(wrong); }),
              ErrorIn("scene.glb", "materials[0].extensions.KHR_materials_ior.ior"));
}

TEST(GltfSurfaces, AreAtMost64) {
  GlbBuilder b;
  for (int i = 0; i < 70; ++i) {
    json material = mirror;
    material["pbrMetallicRoughness"]["roughnessFactor"] = 0.001 * i;
    b.triangle()["material"] = b.material(material);
  }
  const Scene scene = read(b);
  EXPECT_EQ(scene.layers.size(), 65u);
  EXPECT_EQ(soup_of(scene, 0).triangles.size(), 6u) << "the others are drawn by their colour";
  EXPECT_THAT(remark_text(scene, remarks::surface_dropped), ::testing::HasSubstr("more than 64"));
}

// The limit on instances counts all soups of a file.
TEST(GltfSurfaces, InstancesOfManyCannotFillTheMemory) {
  GlbBuilder b;
  const int accessor =
      b.add_accessor({{"componentType", 5126}, {"count", 3000000}, {"type", "VEC3"}});
  for (int i = 0; i < 20; ++i) {
    json material = mirror;
    material["pbrMetallicRoughness"]["roughnessFactor"] = 0.001 * i;
    const int index = b.material(material);
    b.primitive({{"POSITION", accessor}})["material"] = index;
  }
  EXPECT_THAT(error_of([&] { read(b); }), ErrorIn("scene.glb", 16777216));
}

/// What three.js's GLTFExporter writes of a floor, a mirror and glass: 16-bit indices, normals,
/// texture coordinates, the thickness and the attenuation of glass.
GlbBuilder three_js_scene() {
  GlbBuilder b;
  b.document["asset"]["generator"] = "THREE.GLTFExporter r169";
  b.document["extensionsUsed"] = {"KHR_materials_transmission", "KHR_materials_volume",
                                  "KHR_materials_ior"};
  const auto add = [&](const char* name, float x, const json& material) {
    // An octahedron with the normals of a ball.
    std::vector<float> positions, normals;
    for (int axis = 0; axis < 3; ++axis)
      for (const float side : {1.0f, -1.0f})
        for (int k = 0; k < 3; ++k) {
          normals.push_back(k == axis ? side : 0.0f);
          positions.push_back((k == axis ? 0.5f * side : 0.0f));
        }
    std::vector<std::uint16_t> indices;
    for (const std::uint16_t a : {0, 1})
      for (const std::uint16_t c : {2, 3})
        for (const std::uint16_t d : {4, 5}) indices.insert(indices.end(), {a, c, d});
    json& mesh = b.document["meshes"];
    const json primitive = {{"mode", 4},
                            {"attributes",
                             {{"POSITION", b.floats(positions, 3)},
                              {"NORMAL", b.floats(normals, 3)},
                              {"TEXCOORD_0", b.floats(std::vector<float>(12, 0.0f), 2)}}},
                            {"indices", b.accessor(indices, "SCALAR", 5123, indices.size())},
                            {"material", b.material(material)}};
    mesh.push_back({{"primitives", json::array({primitive})}});
    b.document["nodes"].push_back(
        {{"name", name}, {"mesh", mesh.size() - 1}, {"translation", {x, 0, 0}}});
    b.document["scenes"][0]["nodes"].push_back(b.document["nodes"].size() - 1);
  };
  b.document["meshes"] = b.document["nodes"] = b.document["scenes"][0]["nodes"] = json::array();
  add("floor", -2,
      {{"pbrMetallicRoughness",
        {{"baseColorFactor", {0.21, 0.21, 0.21, 1}}, {"metallicFactor", 0}}}});
  add("mirror", 0, {{"pbrMetallicRoughness", {{"metallicFactor", 1}, {"roughnessFactor", 0}}}});
  add("glass", 2,
      {{"pbrMetallicRoughness", {{"metallicFactor", 0}, {"roughnessFactor", 0}}},
       {"extensions",
        {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
         {"KHR_materials_volume", {{"thicknessFactor", 1}, {"attenuationDistance", 9}}},
         {"KHR_materials_ior", {{"ior", 1.4}}}}}});
  return b;
}

TEST(GltfSurfaces, OfThreeJsComeBackFromOurGlbToTheBit) {
  const Scene scene = read(three_js_scene());
  ASSERT_EQ(scene.layers.size(), 3u);
  EXPECT_TRUE(is_mirror(*scene.layers[1].material));
  EXPECT_TRUE(is_glass(*scene.layers[2].material));
  EXPECT_EQ(scene.layers[2].material->ior, 1.4f);
  const auto bytes = test::glb_bytes(scene, "three_js");
  Scene expected = scene;
  expected.info.notes = described(scene.info.remarks);  // a file stores remarks as notes
  EXPECT_EQ(test::difference(expected, read_bytes(bytes)), "");

  // Without our extension it is glTF by another program, and says the same.
  json json = test::glb_json(bytes);
  json["extensions"].erase(tureen_extension);
  const Scene foreign = read_bytes(test::with_glb_json(bytes, json));
  ASSERT_EQ(foreign.layers.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(foreign.layers[i].material, scene.layers[i].material) << i;
    EXPECT_EQ(soup_of(foreign, i).positions.size(), soup_of(scene, i).positions.size()) << i;
    // Lit meshes have NORMAL; the floor is unlit, where other viewers ignore it.
    if (i > 0) {
      EXPECT_EQ(soup_of(foreign, i).normals, soup_of(scene, i).normals) << i;
    }
  }
  EXPECT_THAT(json["extensionsUsed"], Contains("KHR_materials_transmission"));
  EXPECT_THAT(json["extensionsUsed"], Contains("KHR_materials_ior"));
}

TEST(TureenGlbSurfaces, AreNamedInTheFileOnlyWhereThereAreSome) {
  Scene scene = read(triangles({mirror}));
  json json = test::glb_json(test::glb_bytes(scene, "mirror"));
  EXPECT_EQ(json["extensions"][tureen_extension]["version"], 1);
  EXPECT_EQ(json["materials"].size(), 2u);
  only_layer(scene).material.reset();
  only_soup(scene).normals.clear();
  json = test::glb_json(test::glb_bytes(scene, "plain"));
  EXPECT_EQ(json["materials"].size(), 1u);
  EXPECT_FALSE(json["extensions"][tureen_extension].contains("normals"));
  EXPECT_THAT(json["extensionsUsed"], Not(Contains("KHR_materials_ior")));
}

TEST(TureenGlbSurfaces, ThatAreWrongAreRefusedWithTheirPlace) {
  const auto bytes =
      test::glb_bytes(test::random_scene(test::surface_glb_kinds()[0], 3, 4), "wrong");
  const auto refusal = [&](const std::function<void(json&)>& change) {
    json changed = test::glb_json(bytes);
    change(changed);
    return error_of([&] { read_bytes(test::with_glb_json(bytes, changed)); });
  };
  ASSERT_EQ(test::glb_json(bytes)["extensions"][tureen_extension]["material"], 1);
  EXPECT_THAT(refusal([](json& j) { j["extensions"][tureen_extension]["material"] = 9; }),
              ErrorIn("scene.glb", "materials", 9));
  EXPECT_THAT(
      refusal([](json& j) { j["materials"][1]["pbrMetallicRoughness"]["roughnessFactor"] = 1.5; }),
      ErrorIn("scene.glb", "materials[1]", "roughness"));
  EXPECT_THAT(refusal([](json& j) {
                j["extensions"][tureen_extension]["normals"] =
                    j["extensions"][tureen_extension]["triangles"];
              }),
              ErrorIn("scene.glb", "accessors"));
  // Positions are no normals: their lengths differ from 1.
  EXPECT_THAT(refusal([](json& j) {
                j["extensions"][tureen_extension]["normals"] =
                    j["extensions"][tureen_extension]["positions"];
              }),
              ErrorIn("scene.glb", "normal of vertex 0"));
}

TEST(TureenGlbSurfaces, WithADefectAreNotWritten) {
  Scene scene = read(triangles({mirror}));
  only_layer(scene).material->ior = 0.5f;
  EXPECT_THROW(write_tureen_glb(scene, test::temporary_glb("never")), UsageError);
  scene = read(triangles({mirror}));
  only_soup(scene).normals[1] = {2, 0, 0};
  EXPECT_THROW(write_tureen_glb(scene, test::temporary_glb("never")), UsageError);
}

}  // namespace gltf_surfaces_test
}  // namespace tureen
