// Foreign glTF: small files made here, each for one feature, then hostile files and a real one. The
// file is long because each sentence of the glTF specification that the reader relies on has its
// own test.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/output.hpp"
#include "formats/common/format_remarks.hpp"
#include "formats/gltf/gltf_remarks.hpp"
#include "formats/gltf_file.hpp"
#include "formats/scene_file.hpp"
#include "formats/tureen_glb/tureen_glb.hpp"
#include "image/png.hpp"
#include "image/srgb.hpp"
#include "tests/formats/glb_builder.hpp"
#include "tests/formats/truncation.hpp"
#include "tests/support/errors.hpp"

namespace tureen {
namespace gltf_test {

using nlohmann::json;
using test::error_of;
using test::ErrorIn;
using test::GlbBuilder;
using test::Refusal;
using ::testing::Contains;

class Gltf : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(::testing::TempDir()) / (std::string("gltf_") + test->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path save(const std::string& name, std::span<const std::byte> bytes) {
    Output output(folder_ / name);
    output.write(bytes);
    output.commit();
    return folder_ / name;
  }
  Scene read(const GlbBuilder& builder, const ReadOptions& options = {}) {
    return read_gltf_or_glb(save("scene.glb", builder.glb()), options);
  }
  std::optional<Refusal> refusal(const GlbBuilder& builder) {
    return error_of([&] { read(builder); });
  }
  std::filesystem::path folder_;
};

const std::vector<glm::vec4>& vertex_colors(const Scene& scene) {
  return std::get<VertexColors>(only_soup(scene).appearance).rgba;
}
const UvTextures& textures(const Scene& scene) {
  return std::get<UvTextures>(only_soup(scene).appearance);
}

TEST_F(Gltf, ReadsABareTriangleAsWhite) {
  GlbBuilder b;
  b.triangle();
  const Scene scene = read(b);
  EXPECT_THAT(only_soup(scene).triangles, ::testing::ElementsAre(glm::uvec3(0, 1, 2)));
  EXPECT_EQ(only_soup(scene).positions[1], glm::vec3(1, 0, 0));
  EXPECT_THAT(vertex_colors(scene), ::testing::Each(glm::vec4(1.0f)));
  EXPECT_EQ(scene.info.up, glm::vec3(0, 1, 0));
  EXPECT_EQ(scene.info.name, "scene");
}

TEST_F(Gltf, AssemblesStripsFansAndEveryIndexType) {
  const std::vector<float> quad = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 2, 2, 0};
  GlbBuilder b;
  const int position = b.floats(quad, 3);
  b.primitive({{"POSITION", position}})["mode"] = 5;
  b.primitive({{"POSITION", position}})["mode"] = 6;
  auto& bytes = b.primitive({{"POSITION", position}});
  bytes["indices"] = b.accessor(std::vector<std::uint8_t>{4, 1, 0}, "SCALAR", 5121, 3);
  auto& words = b.primitive({{"POSITION", position}});
  words["indices"] = b.accessor(std::vector<std::uint16_t>{0, 2, 3}, "SCALAR", 5123, 3);
  auto& longs = b.primitive({{"POSITION", position}});
  longs["indices"] = b.accessor(std::vector<std::uint32_t>{3, 2, 1}, "SCALAR", 5125, 3);
  const Scene scene = read(b);
  const TriangleSoup& soup = only_soup(scene);
  std::vector<std::vector<int>> corners;  // original vertex numbers, found by position
  for (const glm::uvec3& t : soup.triangles) {
    std::vector<int> names;
    for (int k = 0; k < 3; ++k)
      for (int v = 0; v < 5; ++v)
        if (soup.positions[t[k]] == glm::vec3(quad[3 * v], quad[3 * v + 1], quad[3 * v + 2]))
          names.push_back(v);
    corners.push_back(names);
  }
  using Corners = std::vector<std::vector<int>>;
  EXPECT_EQ(corners, (Corners{{0, 1, 2},
                              {1, 3, 2},
                              {2, 3, 4},  // strip
                              {0, 1, 2},
                              {0, 2, 3},
                              {0, 3, 4},  // fan
                              {4, 1, 0},
                              {0, 2, 3},
                              {3, 2, 1}}));
  EXPECT_EQ(soup.positions.size(), 5u + 5u + 3u + 3u + 3u);
}

TEST_F(Gltf, ReadsQuantisedPositionsStridesAndSparseValues) {
  GlbBuilder b;
  b.document["extensionsUsed"] = {"KHR_mesh_quantization"};
  b.document["extensionsRequired"] = {"KHR_mesh_quantization"};
  // Shorts with two bytes of padding: a stride of 8.
  const std::vector<std::int16_t> shorts = {-32768, 0, 32767, 99, 0, 0, 0, 99, 16384, 0, 0, 99};
  const int position = b.accessor(shorts, "VEC3", 5122, 3, true);
  b.document["bufferViews"][0]["byteStride"] = 8;
  b.primitive({{"POSITION", position}});
  // An accessor without a buffer view, with one sparse element.
  const std::vector<std::uint8_t> which = {2};
  const std::vector<float> value = {5, 6, 7};
  const int sparse = b.add_accessor(
      {{"componentType", 5126},
       {"count", 3},
       {"type", "VEC3"},
       {"sparse",
        {{"count", 1},
         {"indices", {{"bufferView", b.view(which.data(), 1)}, {"componentType", 5121}}},
         {"values", {{"bufferView", b.view(value.data(), 12)}}}}}});
  b.primitive({{"POSITION", sparse}});
  const Scene scene = read(b);
  const auto& p = only_soup(scene).positions;
  ASSERT_EQ(p.size(), 6u);
  EXPECT_EQ(p[0], glm::vec3(-1, 0, 1));
  EXPECT_NEAR(p[2].x, 16384 / 32767.0, 1e-6);
  EXPECT_EQ(p[3], glm::vec3(0));
  EXPECT_EQ(p[5], glm::vec3(5, 6, 7));
}

TEST_F(Gltf, ReadsEveryComponentTypeNormalisedOrNot) {
  const auto check = [&](auto zero, int component, double one) {
    using T = decltype(zero);
    const T low = std::numeric_limits<T>::lowest(), high = std::numeric_limits<T>::max();
    for (const bool normalized : {false, true}) {
      GlbBuilder b;
      // Four numbers a vertex, one of them padding, so that every type is aligned.
      const int position = b.accessor(std::vector<T>{low, high, 1, 0, 0, 0, 0, 0, 3, 2, 1, 0},
                                      "VEC3", component, 3, normalized);
      b.document["bufferViews"][0]["byteStride"] = 4 * sizeof(T);
      b.primitive({{"POSITION", position}});
      const glm::vec3 p = only_soup(read(b)).positions[0];
      const double scale = normalized ? one : 1.0;
      SCOPED_TRACE(std::to_string(component) + (normalized ? " normalised" : ""));
      EXPECT_EQ(p.x, float(normalized ? std::max(double(low) / one, -1.0) : double(low)));
      EXPECT_EQ(p.y, float(double(high) / scale));
      EXPECT_NEAR(p.z, 1.0 / scale, 1e-8);  // one rounding of a number up to 1/127
    }
  };
  check(std::int8_t(0), 5120, 127);
  check(std::uint8_t(0), 5121, 255);
  check(std::int16_t(0), 5122, 32767);
  check(std::uint16_t(0), 5123, 65535);
}

TEST_F(Gltf, ReplacesSparseElementsWhetherUsedOrNot) {
  GlbBuilder b;
  std::vector<float> dense;
  for (int v = 0; v < 5; ++v) dense.insert(dense.end(), {float(v), 0, 0});
  const int position = b.floats(dense, 3);
  const std::vector<std::uint8_t> which = {2, 3};  // the face below does not use 2
  const std::vector<float> values = {20, 20, 20, 30, 30, 30};
  b.document["accessors"][std::size_t(position)]["sparse"] = {
      {"count", 2},
      {"indices", {{"bufferView", b.view(which.data(), 2)}, {"componentType", 5121}}},
      {"values", {{"bufferView", b.view(values.data(), 24)}}}};
  b.primitive({{"POSITION", position}})["indices"] =
      b.accessor(std::vector<std::uint8_t>{4, 3, 1}, "SCALAR", 5121, 3);
  const TriangleSoup soup = only_soup(read(b));
  EXPECT_THAT(soup.positions,
              ::testing::ElementsAre(glm::vec3(1, 0, 0), glm::vec3(30), glm::vec3(4, 0, 0)));
  EXPECT_EQ(soup.triangles[0], glm::uvec3(2, 1, 0));
}

TEST_F(Gltf, AppliesTheWholeHierarchyAndInstances) {
  GlbBuilder b;
  b.triangle();
  const double h = std::sqrt(0.5);
  b.document["nodes"] = {
      {{"translation", {10, 0, 0}}, {"children", {1, 2}}},
      {{"rotation", {0, 0, h, h}}, {"scale", {2, 2, 2}}, {"mesh", 0}},  // a quarter turn about z
      {{"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1}}, {"mesh", 0}}};
  const Scene scene = read(b);
  const auto& p = only_soup(scene).positions;
  ASSERT_EQ(p.size(), 6u);
  const auto near = [](glm::vec3 a, glm::vec3 c) { return glm::length(a - c) < 1e-6f; };
  EXPECT_TRUE(near(p[1], {10, 2, 0}));
  EXPECT_TRUE(near(p[2], {8, 0, 0}));
  EXPECT_TRUE(near(p[4], {11, 0, 5}));
}

TEST_F(Gltf, RefusesCyclesAndSecondParents) {
  GlbBuilder b;
  b.triangle();
  b.document["nodes"] = {{{"children", {1}}}, {{"children", {0}}, {"mesh", 0}}};
  EXPECT_THAT(refusal(b), ErrorIn("scene.glb", "nodes[0]"));
  b.document["nodes"] = {{{"children", {1, 2}}}, {{"children", {2}}}, {{"mesh", 0}}};
  EXPECT_THAT(refusal(b), ErrorIn("scene.glb", "nodes[2]"));
}

TEST_F(Gltf, TakesVertexColoursAsLinearUnlessAPythonToolWroteThem) {
  const auto make = [](const char* generator) {
    GlbBuilder b;
    b.document["asset"]["generator"] = generator;
    auto& primitive = b.triangle();
    primitive["attributes"]["COLOR_0"] = b.accessor(
        std::vector<std::uint8_t>{51, 128, 255, 9, 0, 0, 0, 9, 1, 2, 3, 9}, "VEC4", 5121, 3, true);
    return b;
  };
  const Scene linear = read(make("Some exporter"));
  EXPECT_NEAR(vertex_colors(linear)[0].x, srgb_from_linear(0.2), 1e-6);
  EXPECT_EQ(vertex_colors(linear)[0].w, 1.0f);  // the alpha mode is OPAQUE
  EXPECT_THAT(linear.info.remarks, Contains(Remark{&remarks::vertex_colors_linear_by_gltf}));
  for (const char* tool : {"https://github.com/mikedh/trimesh", "Open3D 0.17"}) {
    const Scene srgb = read(make(tool));
    EXPECT_EQ(vertex_colors(srgb)[0], glm::vec4(51 / 255.0f, 128 / 255.0f, 1.0f, 1.0f));
    EXPECT_THAT(srgb.info.remarks, Contains(Remark{&remarks::vertex_colors_srgb_by_generator}));
  }
  EXPECT_EQ(read(make("trimesh")).info.up, glm::vec3(0, 0, 1));
  EXPECT_EQ(read(make("Open3D")).info.up, glm::vec3(0, 1, 0));
  const Scene asked =
      read(make("trimesh"), {.vertex_colors = VertexColorSpace::linear, .progress = {}});
  EXPECT_NEAR(vertex_colors(asked)[0].x, srgb_from_linear(0.2), 1e-6);
  EXPECT_THAT(asked.info.remarks, Contains(Remark{&remarks::vertex_colors_linear}));
}

TEST_F(Gltf, MultipliesTheFactorInLinearLightAndMovesTheCutoffToAHalf) {
  GlbBuilder b;
  auto& primitive = b.triangle();
  primitive["attributes"]["COLOR_0"] = b.floats({0.5f, 1, 1, 0.2f, 1, 1, 1, 0.3f, 1, 1, 1, 1}, 4);
  primitive["material"] =
      b.material({{"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 1, 1, 1}}}},
                  {"alphaMode", "MASK"},
                  {"alphaCutoff", 0.3f}});
  const Scene scene = read(b);
  EXPECT_NEAR(vertex_colors(scene)[0].x, srgb_from_linear(0.25), 1e-6);
  EXPECT_LT(vertex_colors(scene)[0].w, 0.5f);
  EXPECT_EQ(vertex_colors(scene)[1].w, 0.5f);
  EXPECT_GT(vertex_colors(scene)[2].w, 0.5f);
  EXPECT_THAT(scene.info.remarks, Contains(Remark{&remarks::materials_unlit}));
}

TEST_F(Gltf, ClampsFloatColoursBeforeTheFactor) {
  GlbBuilder b;
  auto& primitive = b.triangle();
  // JSON cannot contain NaN, but a buffer can.
  primitive["attributes"]["COLOR_0"] =
      b.floats({2, -1, std::numeric_limits<float>::quiet_NaN(), 1, 1, 1, 0, 0, 0}, 3);
  primitive["material"] =
      b.material({{"pbrMetallicRoughness", {{"baseColorFactor", {0.25, 1, 1, 1}}}}});
  EXPECT_NEAR(vertex_colors(read(b))[0].x, srgb_from_linear(0.25), 1e-6);
  b.document["asset"]["generator"] = "trimesh";
  b.document["meshes"][0]["primitives"][0].erase("material");
  EXPECT_EQ(vertex_colors(read(b))[0], glm::vec4(1, 0, 0, 1));
}

TEST_F(Gltf, PrimitivesThatShareOneAccessorCostWhatTheyUse) {
  // 3,000 primitives of one triangle each, spread over 3,000,000 vertices. If each read the whole
  // accessor, this would take minutes.
  constexpr std::size_t primitives = 3000, stride = 1000;
  GlbBuilder b;
  std::vector<float> positions(3 * primitives * stride);
  for (std::size_t i = 0; i < positions.size(); ++i) positions[i] = float(i);
  const int position = b.floats(positions, 3);
  std::vector<std::uint32_t> corners;
  for (std::size_t p = 0; p < primitives; ++p)  // not in the accessor's order
    for (const std::size_t k : {7, 3, 5}) corners.push_back(std::uint32_t(p * stride + k));
  const int view = b.view(corners.data(), corners.size() * 4);
  for (std::size_t p = 0; p < primitives; ++p)
    b.primitive({{"POSITION", position}})["indices"] = b.add_accessor({{"bufferView", view},
                                                                       {"byteOffset", 12 * p},
                                                                       {"componentType", 5125},
                                                                       {"count", 3},
                                                                       {"type", "SCALAR"}});
  const auto bytes = b.glb();
  const auto path = save("scene.glb", bytes);
  const auto start = std::chrono::steady_clock::now();
  const Scene scene = read_gltf_or_glb(path);
  // It takes a tenth of a second on an idle machine, and many times that under load.
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
  const TriangleSoup& soup = only_soup(scene);
  ASSERT_EQ(soup.triangles.size(), primitives);
  ASSERT_EQ(soup.positions.size(), 3 * primitives);
  for (std::size_t i = 0; i < corners.size(); ++i)
    ASSERT_EQ(soup.positions[soup.triangles[i / 3][int(i % 3)]].x, float(3 * corners[i])) << i;
}

TEST_F(Gltf, ReadsTexturesWithSamplerTransformMaskAndBlend) {
  GlbBuilder b;
  Image8 image(2, 1);
  image.pixels = {{1, 2, 3, 4}, {5, 6, 7, 8}};
  const int texture = b.texture(image, {{"magFilter", 9728}, {"wrapS", 33071}, {"wrapT", 33648}});
  auto& primitive = b.triangle();
  primitive["attributes"]["TEXCOORD_1"] =
      b.accessor(std::vector<std::uint16_t>{0, 0, 65535, 0, 0, 65535}, "VEC2", 5123, 3, true);
  const double pi = 3.14159265358979323846;
  primitive["material"] = b.material({{"pbrMetallicRoughness",
                                       {{"baseColorFactor", {1, 1, 1, 0.5}},
                                        {"baseColorTexture",
                                         {{"index", texture},
                                          {"extensions",
                                           {{"KHR_texture_transform",
                                             {{"offset", {0.25, 0.5}},
                                              {"rotation", pi / 2},
                                              {"scale", {2, 3}},
                                              {"texCoord", 1}}}}}}}}},
                                      {"alphaMode", "BLEND"},
                                      {"extensions", {{"KHR_materials_unlit", json::object()}}}});
  b.document["meshes"][0]["primitives"].push_back(b.document["meshes"][0]["primitives"][0]);
  b.document["meshes"][0]["primitives"][1].erase("material");
  const Scene scene = read(b);
  const UvTextures& t = textures(scene);
  ASSERT_EQ(t.images.size(), 1u);
  EXPECT_EQ(t.images[0].pixels, image.pixels);
  ASSERT_EQ(t.materials.size(), 2u);
  EXPECT_EQ(t.materials[0].filter, UvMaterial::Filter::nearest);
  EXPECT_EQ(t.materials[0].wrap_u, UvMaterial::Wrap::clamp);
  EXPECT_EQ(t.materials[0].wrap_v, UvMaterial::Wrap::mirror);
  EXPECT_EQ(t.materials[0].factor, glm::vec4(1, 1, 1, 0.5f));
  EXPECT_EQ(t.materials[0].mask_threshold, 0.5f);
  EXPECT_TRUE(t.materials[1].images.empty());
  EXPECT_EQ(t.materials[1].mask_threshold, 0.0f);
  EXPECT_THAT(t.material_of_face, ::testing::ElementsAre(0, 1));
  // A quarter turn maps u to -v and v to u.
  EXPECT_LT(glm::length(t.uv[1] - glm::vec2(0.25f, 0.5f - 2.0f)), 1e-5f);
  EXPECT_LT(glm::length(t.uv[2] - glm::vec2(0.25f + 3.0f, 0.5f)), 1e-5f);
  EXPECT_THAT(scene.info.remarks, Contains(Remark{&remarks::blending_cut_out}));
  EXPECT_THAT(scene.info.remarks, ::testing::Not(Contains(Remark{&remarks::materials_unlit})));
}

TEST_F(Gltf, ReadsCameras) {
  GlbBuilder b;
  b.triangle();
  b.document["cameras"] =
      json::array({{{"type", "perspective"},
                    {"name", "front"},
                    {"perspective", {{"yfov", 0.8}, {"znear", 0.1}, {"aspectRatio", 1.5}}}}});
  b.document["nodes"][0]["translation"] = {0, 0, 4};
  b.document["nodes"][0]["scale"] = {2, 2, 2};
  b.document["nodes"][0]["camera"] = 0;
  const Scene scene = read(b);
  ASSERT_EQ(scene.cameras.size(), 1u);
  const Camera& camera = scene.cameras[0];
  EXPECT_EQ(camera.name, "front");
  EXPECT_EQ(camera.width * 2, camera.height * 3);
  EXPECT_NEAR(2 * std::atan(0.5 * camera.height / camera.fy), 0.8, 1e-12);
  EXPECT_NEAR(glm::length(camera.eye() - glm::dvec3(0, 0, 4)), 0.0, 1e-12);

  // The image would be too wide: 720 rows of this shape have 68,400 columns.
  b.document["cameras"][0]["perspective"]["aspectRatio"] = 95;
  EXPECT_TRUE(read(b).cameras.empty());
}

TEST_F(Gltf, RefusesRequiredExtensionsByName) {
  for (const char* name :
       {"KHR_draco_mesh_compression", "KHR_meshopt_compression", "KHR_texture_basisu",
        "KHR_materials_pbrSpecularGlossiness", "ACME_plaid"}) {
    GlbBuilder b;
    b.triangle();
    b.document["extensionsRequired"] = {name};
    EXPECT_THAT(refusal(b), ErrorIn("scene.glb", name));
  }
}

// tinygltf would skip such a material and read on, without its texture.
TEST_F(Gltf, RefusesAColourOfThreeNumbers) {
  GlbBuilder b;
  const int texture = b.texture(Image8(1, 1), {});
  b.triangle()["material"] = b.material(
      {{"pbrMetallicRoughness",
        {{"baseColorFactor", {1, 0.5, 1}}, {"baseColorTexture", {{"index", texture}}}}}});
  EXPECT_THAT(refusal(b), ErrorIn("scene.glb", "baseColorFactor", 4, 3));
}

TEST_F(Gltf, SaysWhereTheFileIsWrong) {
  const auto changed = [&](const std::function<void(GlbBuilder&)>& change) {
    GlbBuilder b;
    auto& primitive = b.triangle();
    primitive["indices"] = b.accessor(std::vector<std::uint8_t>{0, 1, 2}, "SCALAR", 5121, 3);
    change(b);
    return refusal(b);
  };
  EXPECT_EQ(changed([](GlbBuilder&) {}), std::nullopt);
  EXPECT_THAT(changed([](auto& b) { b.document["accessors"][0]["count"] = 4; }),
              ErrorIn("scene.glb", "accessors[0]", 4, 12));
  EXPECT_THAT(changed([](auto& b) { b.document["accessors"][0]["count"] = 18446744073709551615u; }),
              ErrorIn("scene.glb", "accessors[0]"));
  EXPECT_THAT(changed([](auto& b) { b.document["accessors"][0]["byteOffset"] = 8; }),
              ErrorIn("scene.glb", "accessors[0]", 3));
  EXPECT_THAT(changed([](auto& b) { b.document["accessors"][0]["bufferView"] = 9; }),
              ErrorIn("scene.glb", "accessors[0]", 9, 2));
  EXPECT_THAT(changed([](auto& b) { b.document["accessors"][0]["type"] = "VEC2"; }),
              ErrorIn("scene.glb", "accessors[0]"));
  EXPECT_THAT(changed([](auto& b) { b.document["accessors"][0]["componentType"] = 5130; }),
              ErrorIn("scene.glb", "accessors[0]", 5130));
  EXPECT_THAT(changed([](auto& b) {
                b.document["accessors"][0].erase("bufferView");
                b.document["accessors"][0]["count"] = 1u << 30;
              }),
              ErrorIn("scene.glb"));
  EXPECT_THAT(changed([](auto& b) { b.document["bufferViews"][0]["byteStride"] = 4; }),
              ErrorIn("scene.glb", 4));
  EXPECT_THAT(changed([](auto& b) { b.document["bufferViews"][0]["byteOffset"] = 1e9; }),
              ErrorIn("scene.glb", "bufferViews[0]"));
  EXPECT_THAT(changed([](auto& b) { b.document["bufferViews"][0]["buffer"] = 3; }),
              ErrorIn("scene.glb", "bufferViews[0]", 3, 1));
  EXPECT_THAT(changed([](auto& b) {
                b.document["accessors"][0]["count"] = 2;  // index 2 is now out of range
              }),
              ErrorIn("scene.glb", "accessors[1]", 2));
  EXPECT_THAT(changed([](auto& b) { b.document["nodes"][0]["mesh"] = 4; }),
              ErrorIn("scene.glb", 4, 1));
  EXPECT_THAT(changed([](auto& b) { b.document["scene"] = 4; }), ErrorIn("scene.glb", 4, 1));
  EXPECT_THAT(changed([](auto& b) { b.document["meshes"][0]["primitives"][0]["material"] = 2; }),
              ErrorIn("scene.glb", 2, 0));
  EXPECT_THAT(changed([](auto& b) {
                b.document["nodes"][0]["scale"] = {1, 2};
              }),
              ErrorIn("scene.glb", "nodes[0].scale", 3));
  EXPECT_THAT(changed([](auto& b) { b.document["asset"]["version"] = "1.0"; }),
              ErrorIn("scene.glb", "asset.version", "1.0", "2.0"));
  EXPECT_THAT(changed([](auto& b) {
                json deep = 1;
                for (int i = 0; i < 100; ++i) deep = json::array({deep});
                b.document["extras"] = deep;
              }),
              ErrorIn("scene.glb", 64));
}

TEST_F(Gltf, InstancesCannotFillTheMemory) {
  GlbBuilder b;
  b.primitive({{"POSITION",
                b.add_accessor({{"componentType", 5126}, {"count", 3000000}, {"type", "VEC3"}})}});
  b.document["nodes"] = json::array();
  json& roots = b.document["scenes"][0]["nodes"] = json::array();
  for (int i = 0; i < 100; ++i) {
    b.document["nodes"].push_back({{"mesh", 0}});
    roots.push_back(i);
  }
  EXPECT_THAT(refusal(b), ErrorIn("scene.glb", 16777216));
}

TEST_F(Gltf, OpensFilesInItsFolderOnly) {
  GlbBuilder b;
  b.triangle();
  json document = b.document;
  document["buffers"] = json::array({{{"byteLength", b.bytes().size()}, {"uri", "sub/a b.bin"}}});
  std::filesystem::create_directories(folder_ / "scene" / "sub");
  save("scene/sub/a b.bin", b.bytes());
  save("outside.bin", b.bytes());
  std::filesystem::create_symlink(folder_ / "outside.bin", folder_ / "scene" / "link.bin");
  const auto with_uri = [&](const std::string& uri) {
    document["buffers"][0]["uri"] = uri;
    const std::string text = document.dump();
    const auto path = save("scene/a.gltf", std::as_bytes(std::span(text)));
    return error_of([&] { EXPECT_EQ(only_soup(read_gltf_or_glb(path)).triangles.size(), 1u); });
  };
  EXPECT_EQ(with_uri("sub/a%20b.bin"), std::nullopt);
  EXPECT_THAT(with_uri("../outside.bin"), ErrorIn("a.gltf", "buffers[0].uri", "../outside.bin"));
  EXPECT_THAT(with_uri((folder_ / "outside.bin").string()),
              ErrorIn("a.gltf", "buffers[0].uri", (folder_ / "outside.bin").string()));
  EXPECT_THAT(with_uri("link.bin"), ErrorIn("a.gltf", "buffers[0].uri", "link.bin"));
  EXPECT_THAT(with_uri("missing.bin"), ErrorIn("a.gltf", "missing.bin"));
  EXPECT_THAT(with_uri("data:application/octet-stream;base64,AAAA"), ErrorIn("a.gltf", 3));
  document["buffers"][0]["byteLength"] = 1u << 30;
  EXPECT_THAT(with_uri("sub/a%20b.bin"), ErrorIn("a.gltf"));
}

TEST_F(Gltf, SurvivesTruncationAndDamage) {
  GlbBuilder b;
  auto& primitive = b.triangle();
  primitive["indices"] = b.accessor(std::vector<std::uint8_t>{0, 1, 2}, "SCALAR", 5121, 3);
  primitive["attributes"]["TEXCOORD_0"] = b.floats({0, 0, 1, 0, 0, 1}, 2);
  primitive["material"] = b.material(
      {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", b.texture(Image8(2, 2))}}}}}});
  const auto bytes = b.glb();
  const auto read_bytes = [&](std::span<const std::byte> damaged) {
    EXPECT_FALSE(defect(only_soup(read_gltf_or_glb(save("damaged.glb", damaged)))));
  };
  EXPECT_EQ(test::survive_truncation(bytes, read_bytes).read, 0u);
  test::Survival survival;
  std::vector<std::byte> damaged(bytes);
  for (std::size_t i = 0; i < bytes.size(); ++i)
    for (const unsigned flip : {0x01u, 0x08u, 0x40u, 0xffu}) {
      damaged[i] = bytes[i] ^ std::byte(flip);
      test::expect_survival(damaged, read_bytes, "byte " + std::to_string(i), survival);
      damaged[i] = bytes[i];
    }
  EXPECT_GT(survival.refused, bytes.size());
}

/// A GLB of these chunks. If it `pads`, zeros follow each, which its length does not count.
std::vector<std::byte> glb_of_chunks(
    const std::vector<std::pair<std::uint32_t, std::string>>& chunks, bool pads) {
  std::string body;
  const auto add = [&](std::uint64_t value) {
    for (int i = 0; i < 4; ++i) body += char(value >> (8 * i) & 255);
  };
  for (const auto& [type, content] : chunks) {
    add(content.size());
    add(type);
    body += content;
    if (pads) body.append((4 - content.size() % 4) % 4, '\0');
  }
  const std::string chunks_of_file = std::exchange(body, "glTF");
  add(2);
  add(12 + chunks_of_file.size());
  body += chunks_of_file;
  const auto bytes = std::as_bytes(std::span(body));
  return {bytes.begin(), bytes.end()};
}

TEST_F(Gltf, ChunksOfOddLengthAreReadWithARemark) {
  GlbBuilder b;
  b.triangle();
  b.document["buffers"] = nlohmann::json::array({{{"byteLength", b.bytes().size()}}});
  std::string text = b.document.dump();
  while (text.size() % 4 != 3) text += ' ';
  const std::string binary(reinterpret_cast<const char*>(b.bytes().data()), b.bytes().size());
  for (const bool pads : {true, false})
    for (const std::string& end : {std::string(), std::string("x")}) {
      const auto bytes = glb_of_chunks({{0x4E4F534A, text}, {0x004E4942, binary + end}}, pads);
      const Scene scene = read_gltf_or_glb(save("odd.glb", bytes));
      EXPECT_EQ(only_soup(scene).triangles.size(), 1u);
      EXPECT_THAT(scene.info.remarks, ::testing::Contains(Remark{&remarks::chunks_unaligned}));
      EXPECT_EQ(test::survive_truncation(bytes,
                                         [&](std::span<const std::byte> damaged) {
                                           read_gltf_or_glb(save("odd.glb", damaged));
                                         })
                    .read,
                0u);
    }
}

TEST_F(Gltf, ExtensionsThatAreNotDrawnAreNamed) {
  GlbBuilder b;
  b.triangle();
  b.document["extensionsUsed"] = {"KHR_lights_punctual", "KHR_materials_unlit",
                                  "KHR_materials_clearcoat"};
  const Scene scene = read_gltf_or_glb(save("lit.glb", b.glb()));
  EXPECT_THAT(scene.info.remarks,
              ::testing::Contains(Remark{
                  &remarks::extensions_dropped,
                  {{"extensions",
                    std::vector<std::string>{"KHR_lights_punctual", "KHR_materials_clearcoat"}}}}));

  // Files may also require them.
  b.document.erase("extensionsUsed");
  b.document["extensionsRequired"] = {"KHR_lights_punctual", "KHR_materials_unlit",
                                      "KHR_materials_clearcoat"};
  EXPECT_EQ(read_gltf_or_glb(save("lit.glb", b.glb())).info.remarks, scene.info.remarks);
}

TEST_F(Gltf, CompressedFilesNameTheCommandThatDecompresses) {
  for (const char* name : {"KHR_draco_mesh_compression", "KHR_meshopt_compression"}) {
    GlbBuilder b;
    b.triangle();
    b.document["extensionsRequired"] = {name};
    EXPECT_THAT(refusal(b),
                ErrorIn("scene.glb", name, "gltf-transform copy IN.glb OUT.glb decompresses it"));
  }
}

TEST_F(Gltf, DispatchesOurOwnFiles) {
  TriangleSoup soup;
  soup.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  soup.triangles = {{0, 1, 2}};
  soup.appearance = FaceColors{{{0.1f, 0.2f, 0.3f, 1.0f}}};
  Scene scene = scene_of(std::move(soup));
  scene.info.name = "ours";
  write_tureen_glb(scene, folder_ / "ours.glb");
  const Scene back = read_gltf_or_glb(folder_ / "ours.glb");
  EXPECT_EQ(back.info.name, "ours");
  EXPECT_TRUE(std::holds_alternative<FaceColors>(only_soup(back).appearance));
}

const std::filesystem::path data = std::filesystem::path(TUREEN_SOURCE_DIR) / "../shared/data";

TEST_F(Gltf, HostileFilesEndInAResultOrASentence) {
  if (!std::filesystem::exists(data / "hostile/gltf")) GTEST_SKIP() << "no shared data";
  std::size_t read_count = 0, refused = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(data / "hostile/gltf")) {
    const auto extension = entry.path().extension();
    if (extension != ".gltf" && extension != ".glb") continue;
    SCOPED_TRACE(entry.path().string());
    try {
      const Scene scene = read_scene(entry.path());
      EXPECT_FALSE(defect(only_soup(scene)));
      EXPECT_FALSE(only_soup(scene).triangles.empty());
      std::printf("  read     %s (%zu triangles)\n", entry.path().filename().c_str(),
                  only_soup(scene).triangles.size());
      ++read_count;
    } catch (const InputError& error) {
      EXPECT_FALSE(error.position().file.empty());
      EXPECT_GT(error.reason().size(), 10u) << error.reason();
      std::printf("  refused  %s: %s\n", entry.path().filename().c_str(), error.reason().c_str());
      ++refused;
    }
  }
  EXPECT_GT(read_count, 3u);
  EXPECT_GT(refused, 30u);
}

TEST_F(Gltf, ReadsTheFicus) {
  const auto path = data / "soups/ficus_2dts.glb";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no shared data";
  const Scene scene = read_gltf_or_glb(path);
  const TriangleSoup& soup = only_soup(scene);
  EXPECT_EQ(soup.triangles.size(), 33417u);
  EXPECT_EQ(soup.positions.size(), 100251u);
  const Bounds box = bounds(soup);
  EXPECT_FLOAT_EQ(box.high.z, 1.141271948814392f);
  EXPECT_FLOAT_EQ(box.low.y, -0.857197105884552f);
  EXPECT_EQ(scene.info.up, glm::vec3(0, 0, 1));
  EXPECT_TRUE(scene.info.up_is_assumed);
  EXPECT_THAT(scene.info.remarks, Contains(Remark{&remarks::up_unknown_to_trimesh}));
  EXPECT_THAT(scene.info.remarks, Contains(Remark{&remarks::vertex_colors_srgb_by_generator}));
}

}  // namespace gltf_test
}  // namespace tureen
