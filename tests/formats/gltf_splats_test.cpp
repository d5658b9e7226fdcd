// Foreign glTF with KHR_gaussian_splatting. The fixtures data/splat_transform.* are five random
// splats of degree 1, and the same splats in a GLB by @playcanvas/splat-transform 2.7.1:
//   npx splat-transform splat_transform.ply splat_transform.glb
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/output.hpp"
#include "formats/common/format_remarks.hpp"
#include "formats/gltf/gltf_remarks.hpp"
#include "formats/gltf_file.hpp"
#include "formats/scene_file.hpp"
#include "formats/splat/spz.hpp"
#include "scene/spherical_harmonics.hpp"
#include "tests/formats/format_testing.hpp"
#include "tests/formats/glb_builder.hpp"
#include "tests/formats/splat/spz_fixture.hpp"
#include "tests/formats/truncation.hpp"
#include "tests/support/errors.hpp"

namespace tureen {
namespace gltf_splats_test {

using nlohmann::json;
using test::error_of;
using test::GlbBuilder;
using test::Names;
using ::testing::Contains;
using ::testing::ElementsAre;

constexpr char khr[] = "KHR_gaussian_splatting";

std::string khr_attribute(const std::string& name) { return std::string(khr) + ":" + name; }

/// A primitive of `count` splats of degree 0; splat i is at (i, 0, 0).
json& add_splats(GlbBuilder& b, std::size_t count) {
  std::vector<float> positions, rotations, scales, opacity, colors;
  for (std::size_t i = 0; i < count; ++i) {
    positions.insert(positions.end(), {float(i), 0, 0});
    rotations.insert(rotations.end(), {0, 0, 0.6f, 0.8f});
    scales.insert(scales.end(), {1, 2, 3});
    opacity.push_back(0.5f);
    colors.insert(colors.end(), {1, -1, 0.25f});
  }
  const json attributes = {{"POSITION", b.floats(positions, 3)},
                           {khr_attribute("ROTATION"), b.floats(rotations, 4)},
                           {khr_attribute("SCALE"), b.floats(scales, 3)},
                           {khr_attribute("OPACITY"), b.floats(opacity, 1)},
                           {khr_attribute("SH_DEGREE_0_COEF_0"), b.floats(colors, 3)}};
  json& primitive = b.primitive(attributes);
  primitive["mode"] = 0;
  primitive["extensions"][khr] = {{"kernel", "ellipse"}, {"colorSpace", "srgb_rec709_display"}};
  b.document["extensionsUsed"] = {khr};
  return primitive;
}

Scene read(const GlbBuilder& b) {
  const test::TemporaryFolder folder;
  Output output(folder / "splats.glb");
  output.write(b.glb());
  output.commit();
  return read_gltf_or_glb(folder / "splats.glb");
}

const Splats& splats_of(const Scene& scene, std::size_t layer = 0) {
  return std::get<Splats>(scene.layers.at(layer).primitives);
}
const Gaussians& gaussians_of(const Scene& scene, std::size_t layer = 0) {
  return std::get<Gaussians>(splats_of(scene, layer).kernel);
}

TEST(GltfSplats, OfAHandWrittenFileHaveItsValues) {
  // 60 bytes: POSITION 1 2 3, ROTATION 0 0 1 1, SCALE 0.5 0.25 2, OPACITY 0.75, SH 1 0 -1, and one
  // float of 0.
  const test::TemporaryFolder folder;
  const auto path = folder / "one.gltf";
  std::ofstream(path)
      << R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
    "extensionsUsed": ["KHR_gaussian_splatting"], "extensionsRequired": ["KHR_gaussian_splatting"],
    "nodes": [{"mesh": 0, "name": "one", "translation": [10, 0, 0]}],
    "buffers": [{"byteLength": 60, "uri": "data:application/octet-stream;base64,)"
         "AACAPwAAAEAAAEBAAAAAAAAAAAAAAIA/AACAPwAAAD8AAIA+AAAAQAAAQD8AAIA/AAAAAAAAgL8"
         R"(AAAAA"}],
    "bufferViews": [{"buffer": 0, "byteLength": 60}],
    "accessors": [
      {"bufferView": 0, "componentType": 5126, "count": 1, "type": "VEC3",
       "min": [1, 2, 3], "max": [1, 2, 3]},
      {"bufferView": 0, "byteOffset": 12, "componentType": 5126, "count": 1, "type": "VEC4"},
      {"bufferView": 0, "byteOffset": 28, "componentType": 5126, "count": 1, "type": "VEC3"},
      {"bufferView": 0, "byteOffset": 40, "componentType": 5126, "count": 1, "type": "SCALAR"},
      {"bufferView": 0, "byteOffset": 44, "componentType": 5126, "count": 1, "type": "VEC3"}],
    "meshes": [{"primitives": [{"mode": 0, "attributes": {"POSITION": 0,
      "KHR_gaussian_splatting:ROTATION": 1, "KHR_gaussian_splatting:SCALE": 2,
      "KHR_gaussian_splatting:OPACITY": 3, "KHR_gaussian_splatting:SH_DEGREE_0_COEF_0": 4},
      "extensions": {"KHR_gaussian_splatting":
        {"kernel": "ellipse", "colorSpace": "srgb_rec709_display"}}}]}]})";
  const Scene scene = read_gltf_or_glb(path);
  ASSERT_EQ(scene.layers.size(), 1u);
  EXPECT_EQ(scene.layers[0].name, "one");
  EXPECT_EQ(glm::dvec3(scene.layers[0].world_from_layer[3]), glm::dvec3(10, 0, 0));
  EXPECT_EQ(splats_of(scene).profile, *profile_named("3dgs"));
  EXPECT_EQ(splats_of(scene).color.degree, 0);
  EXPECT_THAT(splats_of(scene).color.coefficients, ElementsAre(glm::vec3(1, 0, -1)));
  const Gaussians& gaussians = gaussians_of(scene);
  EXPECT_FALSE(gaussians.flat);
  EXPECT_THAT(gaussians.centers, ElementsAre(glm::vec3(1, 2, 3)));
  EXPECT_THAT(gaussians.scales, ElementsAre(glm::vec3(0.5f, 0.25f, 2)));
  EXPECT_THAT(gaussians.opacity, ElementsAre(0.75f));
  const float half = float(std::sqrt(0.5));
  EXPECT_THAT(gaussians.rotations, ElementsAre(glm::quat(half, 0, 0, half)));  // w, x, y, z
  EXPECT_THAT(scene.info.remarks, ::testing::IsEmpty());
}

TEST(GltfSplats, WithIntegersAreNormalised) {
  GlbBuilder b;
  auto& attributes = add_splats(b, 1)["attributes"];
  attributes[khr_attribute("OPACITY")] =
      b.accessor(std::vector<std::uint8_t>{51}, "SCALAR", 5121, 1, true);
  attributes[khr_attribute("ROTATION")] =
      b.accessor(std::vector<std::int16_t>{0, -32767, 0, 0}, "VEC4", 5122, 1, true);
  const Scene scene = read(b);
  EXPECT_FLOAT_EQ(gaussians_of(scene).opacity.at(0), 0.2f);
  EXPECT_EQ(gaussians_of(scene).rotations.at(0), glm::quat(0, 0, -1, 0));
}

TEST(GltfSplats, BesideTrianglesAreLayersOfTheirOwn) {
  GlbBuilder b;
  add_splats(b, 2);
  b.triangle();
  add_splats(b, 3);
  const Scene scene = read(b);
  ASSERT_EQ(scene.layers.size(), 3u);
  EXPECT_EQ(std::get<TriangleSoup>(scene.layers[0].primitives).triangles.size(), 1u);
  EXPECT_EQ(count(splats_of(scene, 1)), 2u);
  EXPECT_EQ(count(splats_of(scene, 2)), 3u);
}

/// A primitive whose splats are this SPZ file.
json& add_spz(GlbBuilder& b, const std::string& spz, const json& method) {
  json& primitive = b.primitive(json::object());
  primitive["mode"] = 0;
  primitive["extensions"][khr] = method;
  primitive["extensions"][khr]["extensions"]["KHR_gaussian_splatting_compression_spz_2"] = {
      {"bufferView", b.view(spz.data(), spz.size())}};
  b.document["extensionsUsed"] = {khr, "KHR_gaussian_splatting_compression_spz_2"};
  b.document["extensionsRequired"] = b.document["extensionsUsed"];
  return primitive;
}

const json khr_method = {{"kernel", "ellipse"}, {"colorSpace", "srgb_rec709_display"}};

glm::dvec3 world_center(const Scene& scene) {
  return scene.layers.at(0).world_from_layer * glm::dvec4(gaussians_of(scene).centers.at(0), 1);
}

TEST(GltfSplats, InSpzFilesAreTurnedAsTheDraftSpecifies) {
  for (const unsigned version : {2u, 3u, 4u}) {
    const std::string spz = test::spz_splat(version, 3).bytes();
    GlbBuilder b;
    // Accessors of the result, which have no bytes.
    add_spz(b, spz, khr_method)["attributes"]["POSITION"] =
        b.add_accessor({{"componentType", 5126}, {"count", 1}, {"type", "VEC3"}});
    b.document["nodes"][0]["translation"] = {10, 20, 30};
    b.document["nodes"][0]["name"] = "one";
    const Scene scene = read(b);
    ASSERT_EQ(scene.layers.size(), 1u) << version;
    EXPECT_EQ(scene.layers[0].name, "one");
    // Stored as (1.5, -2.25, 0.5) right, up, back; then left, up, front, then the node's place.
    EXPECT_EQ(world_center(scene), glm::dvec3(8.5, 17.75, 29.5));
    EXPECT_THAT(scene.info.remarks,
                ElementsAre(Remark{&remarks::spz_axes_of_draft,
                                   {{"extension", "KHR_gaussian_splatting_compression_spz_2"}}}));
    EXPECT_EQ(scene.info.up, glm::vec3(0, 1, 0));
    // What differs from the SPZ file alone is the place.
    Input input = test::input_of(spz);
    const Scene alone = read_spz(input);
    EXPECT_EQ(splats_of(scene).color.coefficients, splats_of(alone).color.coefficients);
    EXPECT_EQ(gaussians_of(scene).rotations, gaussians_of(alone).rotations);
    EXPECT_EQ(gaussians_of(scene).scales, gaussians_of(alone).scales);
  }
}

TEST(GltfSplats, InSpzFilesOfOlderWritersKeepTheirAxes) {
  GlbBuilder b;
  add_spz(b, test::spz_splat(2, 1).bytes(), json::object());
  const Scene scene = read(b);
  EXPECT_EQ(world_center(scene), glm::dvec3(1.5, -2.25, 0.5));
  EXPECT_THAT(scene.info.remarks, ElementsAre(Remark{&remarks::spz_axes_stored}));
}

TEST(GltfSplats, InSpzFilesAreRejectedWithTheirPlace) {
  const auto refusal = [](auto&& change) {
    GlbBuilder b;
    const std::string spz = test::spz_splat(3, 0).bytes();
    change(b, add_spz(b, spz, khr_method)["extensions"][khr]);
    return error_of([&] { read(b); });
  };
  constexpr char spz_2[] = "KHR_gaussian_splatting_compression_spz_2";
  EXPECT_THAT(refusal([&](auto&, json& e) { e["extensions"][spz_2]["bufferView"] = "a"; }),
              test::ErrorIn("splats.glb", spz_2, "bufferView"));
  EXPECT_THAT(refusal([&](auto&, json& e) { e["extensions"][spz_2]["bufferView"] = 7; }),
              test::ErrorIn("splats.glb", 7));
  EXPECT_THAT(refusal([&](auto&, json& e) { e["kernel"] = "box"; }),
              test::ErrorIn("splats.glb", "box"));
  EXPECT_THAT(refusal([&](auto& b, json&) { b.document["bufferViews"][0]["byteLength"] = 20; }),
              test::ErrorIn("splats.glb, the SPZ file in bufferViews[0]"));
}

TEST(GltfSplats, InSpzFilesSurviveDamage) {
  GlbBuilder b;
  add_spz(b, test::spz_splat(4, 1).bytes(), khr_method);
  const std::vector<std::byte> bytes = b.glb();
  const auto read_bytes = [](std::span<const std::byte> damaged) {
    Input input = Input::memory("a.glb", damaged);
    const Scene scene = read_gltf_or_glb(input, {});
    for (const Layer& layer : scene.layers) {
      const auto* splats = std::get_if<Splats>(&layer.primitives);
      EXPECT_TRUE(!splats || !defect(*splats));
    }
  };
  EXPECT_EQ(test::survive_truncation(bytes, read_bytes).read, 0u);
  EXPECT_GT(test::survive_damage(bytes, read_bytes).refused, 0u);
}

TEST(GltfSplats, ThatCannotBeDrawnAreDropped) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  GlbBuilder b;
  auto& attributes = add_splats(b, 6)["attributes"];
  attributes["POSITION"] = b.floats({0, 0, 0, nan, 0, 0, 2, 0, 0, 3, 0, 0, 4, 0, 0, 5, 0, 0}, 3);
  attributes[khr_attribute("SCALE")] =
      b.floats({1, 1, 1, 1, 1, 1, 1, -1, 1, 1, 1, 1, 1, 1, 1, 0, 0, 0}, 3);
  attributes[khr_attribute("OPACITY")] = b.floats({0, 1, 1, 1.5f, 1, 1}, 1);
  attributes[khr_attribute("ROTATION")] =
      b.floats({0, 0, 0, 2, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0}, 4);
  const Scene scene = read(b);
  EXPECT_THAT(gaussians_of(scene).centers, ElementsAre(glm::vec3(0), glm::vec3(5, 0, 0)));
  EXPECT_EQ(gaussians_of(scene).rotations[0], glm::quat(1, 0, 0, 0));
  EXPECT_FALSE(defect(splats_of(scene)));
  EXPECT_THAT(scene.info.remarks,
              ElementsAre(Remark{&remarks::splats_dropped, {{"dropped", 4}, {"all", 6}}}));
}

TEST(GltfSplats, InLinearLightHaveARemark) {
  GlbBuilder b;
  add_splats(b, 1)["extensions"][khr]["colorSpace"] = "lin_rec709_display";
  EXPECT_THAT(read(b).info.remarks, ElementsAre(Remark{&remarks::splat_colors_linear}));
}

TEST(GltfSplats, OfOtherMethodsAreRefusedWithTheirPlace) {
  const auto expect_refusal = [](const std::function<void(json&, GlbBuilder&)>& change,
                                 const auto&... values) {
    GlbBuilder b;
    json primitive = add_splats(b, 2);
    change(primitive, b);
    b.document["meshes"][0]["primitives"][0] = primitive;
    EXPECT_THAT(error_of([&] { read(b); }), Names(values...));
  };
  const std::string opacity = khr_attribute("OPACITY");
  expect_refusal([](json& p, auto&) { p["extensions"][khr]["kernel"] = "cube"; },
                 "meshes[0].primitives[0]", "kernel", "cube", "ellipse");
  expect_refusal([](json& p, auto&) { p["extensions"][khr].erase("kernel"); }, "kernel");
  expect_refusal([](json& p, auto&) { p["extensions"][khr]["kernel"] = 1; }, "kernel");
  expect_refusal([](json& p, auto&) { p["extensions"][khr]["colorSpace"] = "xyz"; }, "colorSpace",
                 "xyz");
  expect_refusal([](json& p, auto&) { p["extensions"][khr]["projection"] = "fisheye"; },
                 "projection", "fisheye");
  expect_refusal([](json& p, auto&) { p["mode"] = 4; }, "mode", 4);
  expect_refusal([](json& p, auto&) { p["attributes"].erase("POSITION"); }, "POSITION");
  expect_refusal([&](json& p, auto&) { p["attributes"].erase(opacity); }, opacity);
  expect_refusal([&](json& p, auto& b) { p["attributes"][opacity] = b.floats({1}, 1); }, opacity,
                 "POSITION");
  expect_refusal(
      [&](json& p, auto& b) {
        p["attributes"][opacity] =
            b.accessor(std::vector<std::uint8_t>{1, 0, 0, 0, 1}, "SCALAR", 5121, 2);
      },
      opacity);
  // One coefficient of degree 1 of three, and degree 2 without degree 1.
  expect_refusal(
      [](json& p, auto&) {
        p["attributes"][khr_attribute("SH_DEGREE_1_COEF_0")] = p["attributes"]["POSITION"];
      },
      "degree 1");
  expect_refusal(
      [](json& p, auto&) {
        for (int order = 0; order < 5; ++order)
          p["attributes"][khr_attribute("SH_DEGREE_2_COEF_" + std::to_string(order))] =
              p["attributes"]["POSITION"];
      },
      "degree 2");
  expect_refusal([](json&, auto& b) { b.document["nodes"][0]["scale"] = {1, 2, 1}; }, "nodes[0]");
}

TEST(GltfSplats, BySplatTransformAreThoseOfItsInput) {
  const std::filesystem::path data = TUREEN_SOURCE_DIR "/tests/formats/data";
  const Scene ply = read_scene(data / "splat_transform.ply"),
              glb = read_scene(data / "splat_transform.glb");
  ASSERT_EQ(glb.layers.size(), 1u);
  EXPECT_FALSE(defect(splats_of(glb)));
  EXPECT_EQ(splats_of(glb).profile, splats_of(ply).profile);
  const SplatColor &before = splats_of(ply).color, &after = splats_of(glb).color;
  ASSERT_EQ(after.degree, 1);
  ASSERT_EQ(before.degree, 1);
  const Gaussians &in = gaussians_of(ply), &out = gaussians_of(glb);
  ASSERT_EQ(in.centers.size(), 5u);
  ASSERT_EQ(out.centers.size(), 5u);
  EXPECT_FALSE(out.flat);
  // The program turns a PLY, whose y axis points down, by 180 degrees about z.
  const glm::quat turn(0, 0, 0, 1);
  for (std::size_t i = 0; i < 5; ++i) {
    // Readers sort splats along a curve, which the turn changes.
    const auto at =
        std::find(out.centers.begin(), out.centers.end(), glm::vec3(-1, -1, 1) * in.centers[i]);
    ASSERT_NE(at, out.centers.end());
    const auto j = std::size_t(at - out.centers.begin());
    EXPECT_NEAR(std::abs(glm::dot(out.rotations[j], turn * in.rotations[i])), 1, 1e-6);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(out.scales[j][k], in.scales[i][k], 1e-6);
    EXPECT_NEAR(out.opacity[j], in.opacity[i], 1e-7);
    // The colour in a direction of the turned scene.
    const glm::dvec3 direction = glm::normalize(glm::dvec3(0.3, -0.7, 0.2 * double(i)));
    const auto old_basis = harmonics::basis(direction),
               new_basis = harmonics::basis(glm::dvec3(-1, -1, 1) * direction);
    for (int k = 0; k < 3; ++k) {
      double expected = 0, found = 0;
      for (std::size_t c = 0; c < 4; ++c) {
        expected += old_basis[c] * double(before.coefficients[4 * i + c][k]);
        found += new_basis[c] * double(after.coefficients[4 * j + c][k]);
      }
      EXPECT_NEAR(found, expected, 1e-6);
    }
  }
}

}  // namespace gltf_splats_test
}  // namespace tureen
