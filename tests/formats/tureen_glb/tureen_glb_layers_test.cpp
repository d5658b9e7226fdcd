// Version 4 of TUREEN_triangle_soup: several layers, and layers that are more than a soup at an
// origin.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <set>

#include "base/memory_budget.hpp"
#include "formats/gltf_file.hpp"
#include "formats/tureen_glb/tureen_glb.hpp"
#include "formats/tureen_glb/tureen_glb_preview.hpp"
#include "tests/formats/truncation.hpp"
#include "tests/formats/tureen_glb/tureen_glb_kinds.hpp"
#include "tests/support/errors.hpp"

namespace tureen {
namespace tureen_glb_layers_test {

using test::error_of;
using test::ErrorIn;
using test::fill_soup;
using test::RandomScene;
using ::testing::HasSubstr;

Scene read_bytes(std::span<const std::byte> bytes) {
  Input input = Input::memory("memory.glb", bytes);
  return read_tureen_glb(input);
}

int version_of(std::span<const std::byte> bytes) {
  return test::glb_json(bytes)["extensions"][tureen_extension]["version"];
}

/// A layer with face colours, one with texels, and one of soft triangles.
Scene three_layers(std::size_t faces = 2) {
  return test::layered_scene(
      test::glb_kinds_named({"face_bytes_shared", "lattice_bytes_mlp", "soft_triangles"}), 20,
      faces);
}

TEST(TureenGlbLayers, ComeBackToTheBit) {
  const auto kinds = test::glb_kinds();
  for (const unsigned seed : {1u, 2u})
    for (const std::size_t faces : {std::size_t(1), std::size_t(9)}) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", faces " + std::to_string(faces));
      Scene scene = test::layered_scene(kinds, seed, faces);
      scene.quality.supersampling = 3;
      const auto bytes = test::glb_bytes(scene, "layers");
      EXPECT_EQ(version_of(bytes), 4);
      EXPECT_EQ(test::difference(scene, read_bytes(bytes)), "");
    }
}

TEST(TureenGlbLayers, OfSplatsComeBackToTheBit) {
  const auto kinds = test::every_glb_kind();
  for (const unsigned seed : {1u, 2u})
    for (const std::size_t faces : {std::size_t(0), std::size_t(1), std::size_t(9)}) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", faces " + std::to_string(faces));
      const Scene scene = test::layered_scene(kinds, seed, faces);
      const auto bytes = test::glb_bytes(scene, "splat_layers");
      EXPECT_EQ(version_of(bytes), 5);
      EXPECT_EQ(test::difference(scene, read_bytes(bytes)), "");
    }
}

/// Files from before the rule for centres near the eye are drawn without it, as then.
TEST(TureenGlbLayers, OfSplatsWithoutADepthOfCentersDrawAll) {
  const Scene scene = test::layered_scene(test::glb_kinds_named({"gaussians_3dgs"}), 4, 2);
  const auto bytes = test::glb_bytes(scene, "old_profile");
  auto json = test::glb_json(bytes);
  auto& profile = json["meshes"][0]["primitives"][0]["extensions"]["KHR_gaussian_splatting"]
                      ["extensions"]["TUREEN_splats"]["profile"];
  EXPECT_FLOAT_EQ(profile["min_center_depth"].get<float>(), 0.2f);
  const auto profile_in = [&](const nlohmann::json& changed) {
    const Scene read = read_bytes(test::with_glb_json(bytes, changed));
    return std::get<Splats>(read.layers[0].primitives).profile;
  };
  EXPECT_EQ(profile_in(json), *profile_named("3dgs"));
  profile["min_center_depth"] = -1;
  EXPECT_THROW(profile_in(json), InputError);
  profile.erase("min_center_depth");
  EXPECT_EQ(profile_in(json).min_center_depth, 0);
}

TEST(TureenGlbLayers, WithoutFacesComeBackToo) {
  Scene scene = three_layers();
  scene.layers.insert(scene.layers.begin() + 1, {.name = "empty"});
  scene.layers.push_back({.primitives = Splats{}});
  EXPECT_EQ(test::difference(scene, read_bytes(test::glb_bytes(scene, "empty"))), "");
}

TEST(TureenGlbLayers, AreWrittenOnlyWhereVersionOneLosesThem) {
  RandomScene random(21);
  Scene plain = random.scene();
  fill_soup(plain, random.geometry(2, false), FaceColors{random.colors(2, true)});
  EXPECT_EQ(version_of(test::glb_bytes(plain, "plain")), 1);
  const auto expect_layers = [&](const std::function<void(Layer&)>& change) {
    Scene scene = plain;
    change(scene.layers[0]);
    const auto bytes = test::glb_bytes(scene, "changed");
    EXPECT_EQ(version_of(bytes), 4);
    EXPECT_EQ(test::difference(scene, read_bytes(bytes)), "");
  };
  expect_layers([&](Layer& l) { l.world_from_layer = test::random_similarity(random, false); });
  expect_layers([&](Layer& l) { l.world_from_layer[0][0] = -1; });
  expect_layers([&](Layer& l) { l.visible = false; });
  expect_layers([&](Layer& l) { l.name = "fox"; });
}

// Other viewers place the meshes by the nodes: a valid matrix each, below the node for the up axis.
TEST(TureenGlbLayers, AreNodesWithTheirMatricesForOtherViewers) {
  const Scene scene = three_layers();
  const auto json = test::glb_json(test::glb_bytes(scene, "nodes"));
  EXPECT_EQ(json["scenes"][0]["nodes"], nlohmann::json({0}));
  const auto& nodes = json["nodes"];
  ASSERT_EQ(nodes.size(), 4u);
  EXPECT_EQ(nodes[0]["children"], nlohmann::json({1, 2, 3}));
  EXPECT_EQ(json["extensions"][tureen_extension]["layers"], nodes[0]["children"]);
  EXPECT_EQ(nodes[0]["rotation"].size(), 4u);
  std::set<int> meshes;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& node = nodes[i + 1];
    EXPECT_EQ(node["name"], scene.layers[i].name);
    glm::dmat4 matrix;
    for (int k = 0; k < 16; ++k) matrix[k / 4][k % 4] = node["matrix"][std::size_t(k)];
    EXPECT_EQ(matrix, scene.layers[i].world_from_layer);  // bit by bit: JSON has all digits
    EXPECT_NE(glm::determinant(matrix), 0.0);
    EXPECT_EQ(matrix[3][3], 1.0);
    meshes.insert(node["mesh"].get<int>());
    const auto& primitive = json["meshes"][node["mesh"].get<std::size_t>()]["primitives"][0];
    EXPECT_EQ(json["accessors"][primitive["attributes"]["POSITION"].get<std::size_t>()]["count"],
              6);
    EXPECT_EQ(node["extensions"].contains("KHR_node_visibility"), !scene.layers[i].visible);
  }
  EXPECT_EQ(meshes.size(), 3u);
  EXPECT_THAT(json["extensionsUsed"], ::testing::Contains("KHR_node_visibility"));
  EXPECT_FALSE(json.contains("extensionsRequired"));
}

// Our reader of foreign glTF is another viewer, if the file does not name our extension.
TEST(TureenGlbLayers, AreAtTheirPlacesInOtherViewers) {
  Scene scene =
      test::layered_scene(test::glb_kinds_named({"face_bytes", "face_bytes_shared"}), 23, 4);
  scene.info.up = {0, 1, 0};  // no rotation of the root
  for (Layer& layer : scene.layers) layer.world_from_layer[3] = {10, -20, 30, 1};
  const auto bytes = test::glb_bytes(scene, "foreign");
  auto json = test::glb_json(bytes);
  json.erase("extensions");
  const auto foreign = test::with_glb_json(bytes, json);
  Input input = Input::memory("memory.glb", foreign);
  const Scene seen = read_gltf_or_glb(input, "", {});
  const TriangleSoup& soup = only_soup(seen);
  std::size_t face = 0;
  for (const Layer& layer : scene.layers) {
    const auto& own = std::get<TriangleSoup>(layer.primitives);
    for (const glm::uvec3& triangle : own.triangles) {
      ASSERT_LT(face, soup.triangles.size());
      for (int k = 0; k < 3; ++k) {
        const glm::dvec4 expected =
            layer.world_from_layer * glm::dvec4(own.positions[triangle[k]], 1.0);
        const glm::dvec3 at(soup.positions[soup.triangles[face][k]]);
        // Coordinates below 64 are rounded to float: half a step is 2^-19.
        EXPECT_LT(glm::distance(at, glm::dvec3(expected)), 4e-6);
      }
      ++face;
    }
  }
  EXPECT_EQ(face, soup.triangles.size());
}

TEST(TureenGlbLayers, HaveNoPreview) {
  const auto bytes = test::glb_bytes(three_layers(), "preview");
  EXPECT_EQ(tureen_glb_preview_size(bytes, "memory.glb").value().bytes, 0u);
  EXPECT_FALSE(read_tureen_glb_preview(bytes, "memory.glb"));
}

TEST(TureenGlbLayers, OfFalseFilesAreRefusedWithTheirPlace) {
  const auto bytes = test::glb_bytes(three_layers(), "refused_layers");
  const auto expect_refusal = [&](const std::function<void(nlohmann::json&)>& change,
                                  const auto&... values) {
    auto json = test::glb_json(bytes);
    change(json);
    EXPECT_THAT(error_of([&] { read_bytes(test::with_glb_json(bytes, json)); }),
                ErrorIn("memory.glb", values...));
  };
  const char* x = tureen_extension;
  const auto layers = [&](nlohmann::json& j) -> nlohmann::json& {
    return j["extensions"][x]["layers"];
  };
  expect_refusal([&](auto& j) { j["extensions"][x].erase("layers"); }, "layers");
  expect_refusal([&](auto& j) { layers(j) = nlohmann::json::array(); }, "layers", "no layer");
  expect_refusal([&](auto& j) { layers(j) = std::vector<int>(256, 1); }, "layers", 256, 255);
  expect_refusal([&](auto& j) { layers(j) = {1, 4}; }, "nodes", 4);
  expect_refusal([&](auto& j) { layers(j) = {1, -1}; }, "layers[1]");
  expect_refusal([&](auto& j) { layers(j) = {"fox"}; }, "layers[0]");
  // The same bytes twice, and in the wrong order.
  expect_refusal([&](auto& j) { layers(j) = {1, 1}; }, "previous layer");
  expect_refusal([&](auto& j) { layers(j) = {2, 1}; }, "previous layer");
  // The root of the scene is no layer.
  expect_refusal([&](auto& j) { layers(j) = {0}; }, "nodes[0]", "matrix");
  expect_refusal([&](auto& j) { j["nodes"][1].erase("matrix"); }, "nodes[1]", "matrix");
  expect_refusal([&](auto& j) { j["nodes"][1]["matrix"].erase(0); }, "nodes[1].matrix", 16);
  expect_refusal([&](auto& j) { j["nodes"][1]["matrix"][3] = 0.5; }, "nodes[1].matrix", "last row");
  expect_refusal([&](auto& j) { j["nodes"][2]["matrix"][0] = 77; }, "nodes[2].matrix", "stretches");
  expect_refusal([&](auto& j) { j["nodes"][2]["matrix"][5] = "1"; }, "nodes[2].matrix[5]");
  expect_refusal([&](auto& j) { j["nodes"][1].erase("extensions"); }, "nodes[1]", "extensions");
  expect_refusal([&](auto& j) { j["nodes"][1]["extensions"].erase(x); }, "nodes[1].extensions", x);
  expect_refusal([&](auto& j) { j["nodes"][1]["name"] = 7; }, "nodes[1].name");
  expect_refusal(
      [&](auto& j) { j["nodes"][2]["extensions"]["KHR_node_visibility"]["visible"] = 1; },
      "KHR_node_visibility.visible", "true");
  expect_refusal([&](auto& j) { j["nodes"][2]["extensions"][x]["face_count"] = 4000000000u; },
                 "nodes[2].extensions.TUREEN_triangle_soup");
  expect_refusal(
      [&](auto& j) {
        j["nodes"][3]["extensions"][x]["positions"] = j["nodes"][1]["extensions"][x]["positions"];
      },
      "previous layer");
}

TEST(TureenGlbLayers, OfFalseColoursOfCornersAreRefused) {
  const auto bytes = test::glb_bytes(
      test::layered_scene(test::glb_kinds_named({"windows_with_corner_colors"}), 5, 2), "corners");
  const auto expect_refusal = [&](const auto& change, const auto&... values) {
    auto json = test::glb_json(bytes);
    change(json["nodes"][1]["extensions"][tureen_extension]["appearance"], json);
    EXPECT_THAT(error_of([&] { read_bytes(test::with_glb_json(bytes, json)); }),
                ErrorIn("memory.glb", values...));
  };
  using Json = nlohmann::json;
  // 2 windows x 3 corners x 16 coefficients.
  const auto coefficients = [](Json& appearance, Json& json) -> Json& {
    return json["accessors"][appearance["coefficients"].get<std::size_t>()];
  };
  expect_refusal([](Json& a, Json&) { a["domain"] = "corner"; }, "appearance.domain", "corner");
  expect_refusal([](Json& a, Json&) { a["domain"] = 1; }, "appearance.domain");
  expect_refusal([](Json& a, Json&) { a.erase("domain"); }, 96, 32);
  expect_refusal([](Json& a, Json&) { a["domain"] = "face"; }, 96, 32);
  expect_refusal([&](Json& a, Json& j) { coefficients(a, j)["count"] = 95; }, 95, 96);
}

TEST(TureenGlbLayers, WhatTheReaderRefusesIsNotWritten) {
  const auto refusal = [](const Scene& scene) -> std::string {
    const auto path = test::temporary_glb("never_layers");
    try {
      write_tureen_glb(scene, path);
    } catch (const UsageError& error) {
      EXPECT_FALSE(std::filesystem::exists(path));
      return error.what();
    }
    return "";
  };
  Scene scene = three_layers();
  scene.layers[1].world_from_layer[0][1] = 1e9;
  EXPECT_THAT(refusal(scene), HasSubstr("stretches"));
  scene = three_layers();
  scene.layers[0].world_from_layer[3][0] = std::numeric_limits<double>::infinity();
  EXPECT_THAT(refusal(scene), HasSubstr("not finite"));
  scene.layers.clear();
  EXPECT_THAT(refusal(scene), HasSubstr("no layer"));
  scene.layers.resize(max_layers + 1);
  EXPECT_THAT(refusal(scene), HasSubstr("255"));
  scene.layers.resize(max_layers);
  EXPECT_EQ(read_bytes(test::glb_bytes(scene, "many")).layers.size(), max_layers);
}

TEST(TureenGlbLayers, SurviveTruncationAndDamage) {
  Scene scene = three_layers(1);
  scene.cameras.clear();
  scene.info = SceneInfo();
  const auto bytes = test::glb_bytes(scene, "damaged_layers");
  const auto read = [](std::span<const std::byte> damaged) {
    const Scene back = read_bytes(damaged);
    EXPECT_LE(back.layers.size(), max_layers);
    EXPECT_FALSE(test::scene_defect(back));
  };
  EXPECT_EQ(test::survive_truncation(bytes, read).read, 0u);
  // The frame and the JSON: all later bytes are values and images, as in a file of one layer.
  std::uint32_t json_size = 0;
  std::memcpy(&json_size, bytes.data() + 12, 4);
  std::vector<std::byte> damaged(bytes);
  test::Survival survival;
  for (std::size_t i = 0; i < 28 + json_size; ++i)
    for (const unsigned flip : {0x01u, 0x02u, 0x04u, 0x10u, 0x40u, 0x80u, 0xffu}) {
      damaged[i] = bytes[i] ^ std::byte(flip);
      test::expect_survival(damaged, read,
                            "byte " + std::to_string(i) + " xor " + std::to_string(flip), survival);
      damaged[i] = bytes[i];
    }
  EXPECT_GT(survival.refused, json_size);
}

// 255 layers from the same bytes would take 255 times the memory of one.
TEST(TureenGlbLayers, CannotShareTheirBytes) {
  RandomScene random(22);
  Scene scene = random.scene();
  fill_soup(scene, random.geometry(1000, false), FaceColors{random.colors(1000, false)});
  scene.layers.front().name = "one";
  const auto bytes = test::glb_bytes(scene, "shared");
  auto json = test::glb_json(bytes);
  json["extensions"][tureen_extension]["layers"] = std::vector<int>(255, 1);
  EXPECT_THAT(error_of([&] { read_bytes(test::with_glb_json(bytes, json)); }),
              ErrorIn("memory.glb", "previous layer"));
}

}  // namespace tureen_glb_layers_test
}  // namespace tureen
