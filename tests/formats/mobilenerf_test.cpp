#include "formats/mesh/mobilenerf.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

#include "formats/mesh/mesh_remarks.hpp"
#include "formats/mesh/obj.hpp"
#include "formats/scene_file.hpp"
#include "image/png.hpp"
#include "tests/formats/format_testing.hpp"
#include "tests/formats/truncation.hpp"

namespace tureen {
namespace mobilenerf_test {

using test::error_of;
using test::ErrorAt;
using test::input_of;
using test::TemporaryFolder;
using ::testing::Contains;
using ::testing::IsEmpty;
namespace fs = std::filesystem;

void write_text(const fs::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

void write_png(const fs::path& path, int width, int height, glm::u8vec4 fill) {
  const auto png = encode_png(Image8(width, height, fill));
  write_text(path, {reinterpret_cast<const char*>(png.data()), png.size()});
}

nlohmann::json random_network(unsigned seed, int shapes) {
  std::mt19937 random(seed);
  std::normal_distribution<double> weight(0.0, 0.5);
  nlohmann::json json{{"obj_num", shapes}};
  const int sizes[] = {11, 16, 16, 3};
  for (int l = 0; l < 3; ++l) {
    const std::string name = std::to_string(l);
    for (int i = 0; i < sizes[l]; ++i) {
      nlohmann::json row;
      for (int o = 0; o < sizes[l + 1]; ++o) row.push_back(weight(random));
      json[name + "_weights"].push_back(row);
    }
    for (int o = 0; o < sizes[l + 1]; ++o) json[name + "_bias"].push_back(weight(random));
  }
  return json;
}

const std::string one_quad =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0.25 0.75\nvt 1 0.75\nvt 1 0\nvt 0.25 0\n"
    "f 1/1 2/2 3/3 4/4\n";

/// Writes a scene of two shapes, the second one in two pieces.
void write_scene_folder(const TemporaryFolder& folder) {
  write_text(folder / "mlp.json", random_network(1, 2).dump());
  write_text(folder / "shape0.obj", one_quad);
  write_text(folder / "shape1_0.obj", one_quad);
  write_text(folder / "shape1_1.obj", one_quad);
  write_png(folder / "shape0.pngfeat0.png", 4, 2, {1, 2, 3, 4});
  write_png(folder / "shape0.pngfeat1.png", 4, 2, {5, 6, 7, 8});
  write_png(folder / "shape1.pngfeat0.png", 2, 2, {9, 10, 11, 12});
  write_png(folder / "shape1.pngfeat1.png", 2, 2, {13, 14, 15, 16});
}

TEST(Obj, VerticesAreUnifiedByPairAndPolygonsFanned) {
  const std::string text =
      "# a comment\nmtllib x.mtl\no thing\nv 0 0 0 1\nv 1 0 0\nv 1 1 0\nv 0 1 0 # here too\n"
      "vn 0 0 1\nvt 0 0\nvt 1 0 0\nvt 1 1\ns off\n\nf 1/1/1 2/2/1 3/3/1 4/1/1\r\n"
      "v 5 5 5\nf -1/-3 2/2 3/1\n";
  Input input = input_of(text);
  const ObjMesh mesh = read_obj(input, {.only_uv = true});
  ASSERT_EQ(mesh.triangles.size(), 3u);
  EXPECT_EQ(mesh.triangles[0], glm::uvec3(0, 1, 2));
  EXPECT_EQ(mesh.triangles[1], glm::uvec3(0, 2, 3));
  EXPECT_EQ(mesh.triangles[2], glm::uvec3(4, 1, 5));
  ASSERT_EQ(mesh.positions.size(), 6u);
  EXPECT_EQ(mesh.positions[4], glm::vec3(5));
  EXPECT_EQ(mesh.positions[5], mesh.positions[2]);  // same v, other vt
  EXPECT_EQ(mesh.uv[5], glm::vec2(0, 0));
  EXPECT_EQ(mesh.uv[2], glm::vec2(1, 1));
}

TEST(Obj, MistakesAreNamedWithTheirLine) {
  const auto refusal = [](const std::string& text) {
    const std::string whole = "v 0 0 0\nvt 0 0\n" + text;
    return error_of([&] {
      Input input = input_of(whole, "a.obj");
      read_obj(input, {.only_uv = true});
    });
  };
  EXPECT_EQ(refusal("f 1/1 1/1 1/1\n"), std::nullopt);
  EXPECT_THAT(refusal("f 1/1 1/1 2/1\n"), ErrorAt("a.obj:3", "v", 2, 1));
  EXPECT_THAT(refusal("f 1/1 1/1 1/-2\n"), ErrorAt("a.obj:3", "vt", -2, 1));
  EXPECT_THAT(refusal("f 0/1 1/1 1/1\n"), ErrorAt("a.obj:3", "v", 0, 1));
  EXPECT_THAT(refusal("f 1/1 1/1\n"), ErrorAt("a.obj:3", 2));
  EXPECT_THAT(refusal("\nf 1 1 1\n"), ErrorAt("a.obj:4", 1));
  EXPECT_THAT(refusal("f 1/1x 1/1 1/1\n"), ErrorAt("a.obj:3", "1/1x"));
  EXPECT_THAT(refusal("f 1/99999999999999999999 1/1 1/1\n"),
              ErrorAt("a.obj:3", "1/99999999999999999999"));
  EXPECT_THAT(refusal("v 1 two 3\n"), ErrorAt("a.obj:3", "two"));
  EXPECT_THAT(refusal("vt 1\n"), ErrorAt("a.obj:3"));
}

TEST(MobileNerf, AFolderBecomesOneSoup) {
  const TemporaryFolder folder;
  write_scene_folder(folder);
  for (const char* name : {"", "mlp.json", "shape1_0.obj"})
    EXPECT_TRUE(is_mobilenerf(folder / name)) << name;
  EXPECT_FALSE(is_mobilenerf(folder / "shape0.pngfeat0.png"));
  for (const char* name : {"", "mlp.json", "shape1_0.obj"})
    EXPECT_EQ(only_soup(read_scene(folder / name)).triangles.size(), 6u) << name;
  const Scene scene = read_mobilenerf(folder / "");
  const TriangleSoup& soup = only_soup(scene);
  ASSERT_EQ(defect(soup), std::nullopt);
  EXPECT_THAT(scene.info.remarks, IsEmpty());
  EXPECT_EQ(soup.triangles.size(), 6u);
  EXPECT_EQ(soup.positions.size(), 12u);
  EXPECT_EQ(soup.triangles[2], glm::uvec3(4, 5, 6));
  const auto& textures = std::get<UvTextures>(soup.appearance);
  EXPECT_EQ(textures.material_of_face, (std::vector<std::uint32_t>{0, 0, 1, 1, 1, 1}));
  // In the file, v points upwards.
  EXPECT_EQ(textures.uv[0], glm::vec2(0.25f, 0.25f));
  EXPECT_EQ(textures.uv[2], glm::vec2(1.0f, 1.0f));
  const UvMaterial& material = textures.materials[1];
  EXPECT_EQ(textures.images[material.images[0]].at(1, 1), glm::u8vec4(9, 10, 11, 12));
  EXPECT_EQ(textures.images[material.images[1]].at(1, 1), glm::u8vec4(13, 14, 15, 16));
  EXPECT_EQ(material.filter, UvMaterial::Filter::nearest);
  EXPECT_EQ(material.wrap_u, UvMaterial::Wrap::clamp);
  EXPECT_EQ(material.mask_channel, 0);
  EXPECT_LT(0.0f, material.mask_threshold);
  EXPECT_LT(material.mask_threshold, 1.0f / 255.0f);
  EXPECT_EQ(scene.info.background, glm::vec3(1));
  ASSERT_EQ(scene.cameras.size(), 1u);
  EXPECT_NEAR(glm::distance(scene.cameras[0].eye(), glm::dvec3(0, 2, 3.464)), 0, 1e-12);
}

// The published network, evaluated as in its viewer, against the rewritten one.
TEST(MobileNerf, TheNetworkGivesThePublishedColours) {
  const TemporaryFolder folder;
  write_scene_folder(folder);
  const nlohmann::json json = random_network(1, 2);
  const ColorMlp mlp =
      *std::get<UvTextures>(only_soup(read_mobilenerf(folder / "")).appearance).mlp;
  EXPECT_EQ(mlp.view, ViewConvention::eye_to_surface);
  EXPECT_EQ(mlp.blend_channel, std::nullopt);
  const unsigned seed = 77;
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 100; ++i) {
    std::vector<double> features(8);
    for (double& f : features) f = double(random() % 256) / 255.0;
    const glm::dvec3 d = glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
    std::vector<double> x = features;
    x[3] = 2 * x[3] - 1;
    x[7] = 2 * x[7] - 1;
    x.insert(x.end(), {d.x, -d.z, d.y});
    for (int l = 0; l < 3; ++l) {
      const std::string name = std::to_string(l);
      std::vector<double> y = json[name + "_bias"];
      for (std::size_t o = 0; o < y.size(); ++o) {
        for (std::size_t k = 0; k < x.size(); ++k)
          y[o] += json[name + "_weights"][k][o].get<double>() * x[k];
        y[o] = l == 2 ? 1 / (1 + std::exp(-y[o])) : std::max(y[o], 0.0);
      }
      x = y;
    }
    const glm::dvec3 color = evaluate(mlp, features, -d);
    // Weights are floats: relative errors of 6e-8, over a few dozen terms of order one.
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(color[c], x[std::size_t(c)], 1e-5);
  }
}

TEST(MobileNerf, MissingShapesAreNamedAndTheRestIsDrawn) {
  const TemporaryFolder folder;
  write_scene_folder(folder);
  write_text(folder / "mlp.json", random_network(1, 5).dump());
  fs::remove(folder / "shape0.pngfeat1.png");
  const Scene scene = read_mobilenerf(folder / "mlp.json");
  EXPECT_THAT(scene.info.remarks,
              Contains(Remark{&remarks::shapes_missing,
                              {{"shapes", std::vector<std::uint64_t>{2, 3, 4}}, {"all", 5}}}));
  EXPECT_THAT(scene.info.remarks,
              Contains(Remark{&remarks::shapes_untextured,
                              {{"shapes", std::vector<std::uint64_t>{0}}, {"all", 5}}}));
  EXPECT_EQ(only_soup(scene).triangles.size(), 4u);
  fs::remove(folder / "shape1.pngfeat0.png");
  EXPECT_THAT(error_of([&] { read_mobilenerf(folder / ""); }), ErrorAt("", 5));
}

TEST(MobileNerf, WhatIsWrongIsNamed) {
  const TemporaryFolder folder;
  const auto refusal = [&](auto&& change) {
    write_scene_folder(folder);
    nlohmann::json json = random_network(1, 2);
    change(json);
    write_text(folder / "mlp.json", json.dump());
    return error_of([&] { read_mobilenerf(folder / ""); });
  };
  EXPECT_EQ(refusal([](auto&) {}), std::nullopt);
  EXPECT_THAT(refusal([](auto& j) { j["obj_num"] = 0; }), ErrorAt("mlp.json", "obj_num"));
  EXPECT_THAT(refusal([](auto& j) { j["obj_num"] = 1e9; }), ErrorAt("mlp.json", "obj_num"));
  EXPECT_THAT(refusal([](auto& j) { j.erase("1_bias"); }), ErrorAt("mlp.json", "1_bias"));
  EXPECT_THAT(refusal([](auto& j) { j["0_weights"].erase(3); }), ErrorAt("mlp.json", 11));
  EXPECT_THAT(refusal([](auto& j) { j["2_weights"][4].push_back(1); }),
              ErrorAt("mlp.json", "2_weights[4]", 3));
  EXPECT_THAT(refusal([](auto& j) { j["2_weights"][4][1] = 1e300; }),
              ErrorAt("mlp.json", "2_weights[4][1]"));
  EXPECT_THAT(
      refusal([&](auto&) { write_png(folder / "shape0.pngfeat1.png", 3, 2, glm::u8vec4(1)); }),
      ErrorAt("shape0.pngfeat1.png", 3, 2, "shape0.pngfeat0.png", 4));
  EXPECT_THAT(refusal([&](auto&) { write_text(folder / "shape0.obj", "v 1 2\n"); }),
              ErrorAt("shape0.obj:1"));
}

TEST(Obj, TruncationAndDamageAreSurvived) {
  const auto read = [](std::span<const std::byte> bytes) {
    Input input = Input::memory("a.obj", bytes);
    const ObjMesh mesh = read_obj(input, {.only_uv = true});
    EXPECT_EQ(mesh.uv.size(), mesh.positions.size());
    for (const glm::uvec3& triangle : mesh.triangles)
      for (int k = 0; k < 3; ++k) EXPECT_LT(triangle[k], mesh.positions.size());
  };
  const auto bytes = std::as_bytes(std::span(one_quad));
  EXPECT_GT(test::survive_truncation(bytes, read).refused, 0u);
  EXPECT_GT(test::survive_damage(bytes, read).refused, 0u);
}

TEST(MobileNerf, TruncatedFilesAreSurvived) {
  const TemporaryFolder folder;
  write_scene_folder(folder);
  for (const char* name : {"shape0.obj", "shape0.pngfeat0.png", "mlp.json"}) {
    std::ifstream file(folder / name, std::ios::binary);
    const std::string good{std::istreambuf_iterator<char>(file), {}};
    test::Survival survival;
    for (std::size_t length = 0; length < good.size(); length += 1 + good.size() / 400) {
      const auto read = [&](std::span<const std::byte> bytes) {
        write_text(folder / name, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
        EXPECT_EQ(defect(only_soup(read_mobilenerf(folder / ""))), std::nullopt);
      };
      test::expect_survival(std::as_bytes(std::span(good)).first(length), read,
                            std::string(name) + " cut to " + std::to_string(length), survival);
    }
    EXPECT_GT(survival.refused, 0u) << name;
    write_text(folder / name, good);
  }
}

// A real scene with only one part of its shapes. It stays outside the repository because of its
// licence.
TEST(MobileNerf, TheDrums) {
  const fs::path drums = fs::path(TUREEN_SOURCE_DIR) / "../shared/data/soups/mobilenerf_drums";
  if (!fs::exists(drums)) GTEST_SKIP() << drums << " does not exist";
  const Scene scene = read_mobilenerf(drums);
  const TriangleSoup& soup = only_soup(scene);
  EXPECT_EQ(defect(soup), std::nullopt);
  EXPECT_EQ(soup.triangles.size(), 11026u);
  EXPECT_EQ(scene.info.name, "mobilenerf_drums");
  EXPECT_THAT(scene.info.remarks,
              Contains(Remark{&remarks::shapes_missing,
                              {{"shapes", std::vector<std::uint64_t>{0, 1}}, {"all", 3}}}));
  const Image8& image = std::get<UvTextures>(soup.appearance).images[0];
  EXPECT_EQ(image.width, 4096);
  std::size_t holes = 0;
  for (const glm::u8vec4& texel : image.pixels) holes += texel.r == 0;
  // The source only states "half of the texels are holes"; unused space counts here, too.
  EXPECT_GT(double(holes) / double(image.pixels.size()), 0.4);
  EXPECT_LT(double(holes) / double(image.pixels.size()), 0.99);
}

}  // namespace mobilenerf_test
}  // namespace tureen
