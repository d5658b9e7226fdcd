// OBJ with colours and textures, as a scene. tests/formats/mobilenerf_test.cpp has the shapes of
// MobileNeRF.
#include "formats/mesh/obj.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "base/output.hpp"
#include "formats/mesh/mesh_remarks.hpp"
#include "formats/mesh/mtl.hpp"
#include "formats/scene_file.hpp"
#include "image/png.hpp"
#include "tests/formats/format_testing.hpp"
#include "tests/formats/memory_limit.hpp"
#include "tests/formats/truncation.hpp"
#include "tests/support/errors.hpp"

namespace tureen {
namespace obj_test {

using test::error_of;
using test::ErrorAt;
using test::input_of;
using test::TemporaryFolder;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

void write_file(const std::filesystem::path& path, std::string_view text) {
  Output output(path);
  output.write(text);
  output.commit();
}

void write_image(const std::filesystem::path& path, const Image8& image) {
  Output output(path);
  output.write(encode_png(image));
  output.commit();
}

bool has_remark(const Scene& scene, const RemarkKind& kind) {
  return std::any_of(scene.info.remarks.begin(), scene.info.remarks.end(),
                     [&](const Remark& remark) { return remark.kind == &kind; });
}

TEST(ObjScene, HasTheColoursOfItsVertices) {
  const TemporaryFolder folder;
  write_file(folder / "a.obj",
             "g one\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0\nv 0 1 0 2\nvn 0 0 1\n"
             "f 1//1 2//1 3//1 4//1\ng two\nf -4 \\\n -3 -1\nf 1 2\np 1\n");
  const Scene scene = read_scene(folder / "a.obj");
  const TriangleSoup& soup = only_soup(scene);
  EXPECT_THAT(soup.triangles,
              ElementsAre(glm::uvec3(0, 1, 2), glm::uvec3(0, 2, 3), glm::uvec3(0, 1, 3)));
  const glm::vec4 grey(0.8f, 0.8f, 0.8f, 1);
  EXPECT_THAT(std::get<VertexColors>(soup.appearance).rgba,
              ElementsAre(glm::vec4(1, 0, 0, 1), glm::vec4(0, 1, 0, 1), grey, grey));
  EXPECT_EQ(scene.info.up, glm::vec3(0, 1, 0));
  EXPECT_TRUE(scene.info.up_is_assumed);
  EXPECT_THAT(scene.info.remarks,
              ElementsAre(Remark{&remarks::up_unknown_to_obj},
                          Remark{&remarks::polygons_split, {{"polygons", 1}}},
                          Remark{&remarks::small_faces_dropped, {{"faces", 1}}},
                          Remark{&remarks::points_and_lines_skipped, {{"elements", 1}}}));
}

TEST(ObjScene, HasTheColoursOfItsMaterials) {
  const TemporaryFolder folder;
  write_file(folder / "a b.mtl",
             "# two\nnewmtl red\nKs 1 1 1\nKd 1 0 0.5\nnewmtl a glass\nTr .75\n");
  write_file(folder / "a.obj",
             "mtllib a b.mtl\nmtllib none.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\nusemtl red\n"
             "f 1 2 3\nusemtl a glass\nf 1 2 3\nusemtl blue\nf 1 2 3\n");
  const Scene scene = read_scene(folder / "a.obj");
  const glm::vec4 grey(0.8f, 0.8f, 0.8f, 1);
  EXPECT_THAT(
      std::get<FaceColors>(only_soup(scene).appearance).rgba,
      ElementsAre(grey, glm::vec4(1, 0, 0.5f, 1), glm::vec4(0.8f, 0.8f, 0.8f, 0.25f), grey));
  EXPECT_TRUE(has_remark(scene, remarks::material_library_missing));
  EXPECT_TRUE(has_remark(scene, remarks::transparency_cut_out));
  EXPECT_THAT(scene.info.remarks,
              Contains(Remark{&remarks::materials_missing,
                              {{"materials", std::vector<std::string>{"blue"}}}}));
}

TEST(ObjScene, HasTheTexturesOfItsMaterials) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "maps");
  Image8 image(2, 1);
  image.pixels = {glm::u8vec4(255, 0, 0, 255), glm::u8vec4(0, 0, 255, 255)};
  write_image(folder / "maps/two texels.png", image);
  write_file(folder / "a.mtl",
             "newmtl image\nKd 0 0 0\nmap_Kd -clamp on -s 1 2 1 maps\\two texels.png\n"
             "map_d maps\\two texels.png\n"
             "newmtl again\nKd .5 .5 .5\nmap_Kd maps/two texels.png\n"
             "newmtl none\nKd 0 1 0\nmap_Kd ../a.png\n");
  write_file(folder / "a.obj",
             "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0.25 0.125\nvt 0.75 1\nusemtl image\n"
             "f 1/1 2/2 3/1\nusemtl again\nf 1/1 2/2 3/2\nusemtl none\nf 1 2 3\n");
  const Scene scene = read_scene(folder / "a.obj");
  const TriangleSoup& soup = only_soup(scene);
  const auto& textures = std::get<UvTextures>(soup.appearance);
  ASSERT_EQ(textures.images.size(), 1u);
  EXPECT_EQ(textures.images[0].pixels, image.pixels);
  EXPECT_THAT(textures.material_of_face, ElementsAre(1u, 2u, 3u));
  ASSERT_EQ(textures.materials.size(), 4u);
  const UvMaterial& first = textures.materials[1];
  EXPECT_EQ(first.factor, glm::vec4(1));
  EXPECT_EQ(first.wrap_u, UvMaterial::Wrap::clamp);
  EXPECT_EQ(first.mask_threshold, 0.5f);
  EXPECT_EQ(textures.materials[2].factor, glm::vec4(0.5f, 0.5f, 0.5f, 1));
  EXPECT_EQ(textures.materials[2].mask_threshold, 0.0f);
  EXPECT_THAT(textures.materials[2].images, ElementsAre(0u));
  EXPECT_THAT(textures.materials[3].images, IsEmpty());
  EXPECT_EQ(textures.materials[3].factor, glm::vec4(0, 1, 0, 1));
  // (3, 1) and (3, 2) are two vertices, and each v without vt is one.
  EXPECT_EQ(soup.positions.size(), 7u);
  EXPECT_EQ(textures.uv[soup.triangles[0][0]], glm::vec2(0.25f, 0.875f));
  EXPECT_EQ(textures.uv[soup.triangles[0][1]], glm::vec2(0.75f, 0));
  EXPECT_TRUE(has_remark(scene, remarks::texture_missing));
  EXPECT_TRUE(has_remark(scene, remarks::texture_placement_dropped));
  EXPECT_EQ(defect(soup), std::nullopt);
}

TEST(ObjScene, WrittenIsReadBitForBit) {
  const TemporaryFolder folder;
  Scene scene;
  TriangleSoup soup;
  soup.positions = {{0.1f, -3e-7f, 1e9f}, {1, 0, 0}, {1, 1, 1.0f / 3}, {0, 1, 0}};
  soup.triangles = {{3, 1, 2}, {0, 2, 1}};
  soup.appearance =
      VertexColors{{{0.1f, 0.2f, 0.3f, 1}, {0, 0, 0, 1}, {1, 1, 1, 1}, {0.7f, 0, 1, 1}}};
  scene.layers.push_back({.primitives = soup});
  scene.info.up = obj_up;
  EXPECT_THAT(write_obj(scene, folder / "a.obj"), IsEmpty());
  const TriangleSoup read = only_soup(read_scene(folder / "a.obj"));
  EXPECT_EQ(read.positions, soup.positions);
  EXPECT_EQ(read.triangles, soup.triangles);
  EXPECT_EQ(std::get<VertexColors>(read.appearance).rgba,
            std::get<VertexColors>(soup.appearance).rgba);
}

TEST(ObjScene, MistakesAreNamedWithTheirLine) {
  const TemporaryFolder folder;
  const auto refusal = [&](const std::string& text) {
    write_file(folder / "a.obj", "v 0 0 0\nvt 0 0\n" + text);
    return error_of([&] { read_scene(folder / "a.obj"); });
  };
  EXPECT_EQ(refusal("f 1 1 1\n"), std::nullopt);
  EXPECT_THAT(refusal("f 1 1 2\n"), ErrorAt("a.obj:3", "v", 2, 1));
  EXPECT_THAT(refusal("f 1 1/-2 1\n"), ErrorAt("a.obj:3", "vt", -2, 1));
  EXPECT_THAT(refusal("f 1 1 1x\n"), ErrorAt("a.obj:3", "1x"));
  EXPECT_THAT(refusal("v 0 0 0 1 red 0\n"), ErrorAt("a.obj:3", "red"));
  EXPECT_THAT(refusal(""), ErrorAt("a.obj"));
  write_file(folder / "a.obj", "<!DOCTYPE html><html></html>");
  EXPECT_THAT(error_of([&] { read_scene(folder / "a.obj"); }), ErrorAt("a.obj"));
}

constexpr std::string_view everything =
    "mtllib a.mtl\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 1 1 0\nvt 0.25 0.125\nvt 0.75\nusemtl red\n"
    "f 1/1 2/2 3/1 1//1\nusemtl b\nf -1 -2 \\\n-3/-1/1\nl 1 2\n";
constexpr std::string_view library =
    "newmtl red\nKd 1 0 0\nmap_Kd -s 1 2 -mm 0 1 -clamp on a.png\nnewmtl b\nKd .5\nd .25\nTr .5\n"
    "map_d a.png\n";

TEST(ObjScene, TruncationAndDamageAreSurvived) {
  const auto read = [](std::span<const std::byte> bytes) {
    Input input = Input::memory("a.obj", bytes);
    const ObjMesh mesh = read_obj(input);
    EXPECT_EQ(mesh.material_of_face.size(), mesh.triangles.size());
    for (const std::uint32_t material : mesh.material_of_face)
      EXPECT_LT(material, mesh.materials.size());
    for (const glm::uvec3& triangle : mesh.triangles)
      for (int k = 0; k < 3; ++k) EXPECT_LT(triangle[k], mesh.positions.size());
    for (const std::size_t size : {mesh.uv.size(), mesh.rgb.size()})
      EXPECT_TRUE(size == 0 || size == mesh.positions.size());
  };
  const auto bytes = std::as_bytes(std::span(everything));
  EXPECT_GT(test::survive_truncation(bytes, read).refused, 0u);
  EXPECT_GT(test::survive_damage(bytes, read).refused, 0u);
  const auto read_library = [](std::span<const std::byte> damaged) {
    Input input = Input::memory("a.mtl", damaged);
    read_mtl(input);
  };
  EXPECT_GT(test::survive_truncation(std::as_bytes(std::span(library)), read_library).refused, 0u);
  EXPECT_GT(test::survive_damage(std::as_bytes(std::span(library)), read_library).refused, 0u);
}

TEST(ObjScene, StaysWithinTheMemoryLimit) {
  const TemporaryFolder folder;
  // Names that differ only in their last digits: each is counted.
  std::string text = "v 0 0 0\n";
  for (int i = 0; i < 20000; ++i)
    text += "usemtl " + std::string(100, 'a') + std::to_string(i) + "\nf 1 1 1\n";
  write_file(folder / "a.obj", text);
  const test::MemoryLimit limit(1 << 20);
  EXPECT_THAT(error_of([&] { read_scene(folder / "a.obj"); }),
              test::ErrorIn("a.obj", "--max-memory"));
}

}  // namespace obj_test
}  // namespace tureen
