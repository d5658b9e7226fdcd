#include "formats/diffsoup/diffsoup_export.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <random>
#include <span>

#include "base/output.hpp"
#include "formats/diffsoup/diffsoup_mesh.hpp"
#include "formats/diffsoup/diffsoup_remarks.hpp"
#include "image/png.hpp"
#include "scene/lattice.hpp"
#include "tests/formats/format_testing.hpp"
#include "tests/formats/truncation.hpp"
#include "tests/image/png_sums.hpp"

namespace tureen {
namespace diffsoup_export_test {

using test::error_of;
using test::ErrorAt;
using test::Names;
using test::Refusal;
using test::TemporaryFolder;
using ::testing::Contains;
using ::testing::IsEmpty;
namespace fs = std::filesystem;

ColorMlp random_mlp(std::mt19937& random) {
  std::normal_distribution<float> weight(0.0f, 0.35f);
  ColorMlp mlp{.layers = {},
               .encoding = DirectionEncoding::harmonics2,
               .view = ViewConvention::surface_to_eye,
               .blend_channel = 3};
  for (const int outputs : {16, 16, 3}) {
    DenseLayer layer{16, outputs, std::vector<float>(16 * std::size_t(outputs)),
                     std::vector<float>(std::size_t(outputs))};
    for (float& w : layer.weights) w = weight(random);
    for (float& b : layer.biases) b = weight(random);
    mlp.layers.push_back(std::move(layer));
  }
  return mlp;
}

/// Faces of one level with random float texels; every eighth alpha is 1/2 or close to it.
Scene random_scene(unsigned seed, std::size_t faces, int level) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  TriangleSoup soup;
  LatticeTexture texture;
  const std::size_t per_face = lattice::texel_count(level);
  for (std::size_t t = 0; t < faces; ++t) {
    for (int k = 0; k < 3; ++k) soup.positions.emplace_back(unit(random), unit(random), 2.0f);
    soup.triangles.emplace_back(3 * t, 3 * t + 1, 3 * t + 2);
    texture.patches.push_back({std::uint32_t(t * per_face), std::uint32_t(level)});
  }
  std::vector<float> texels(faces * per_face * LatticeTexture::channels);
  for (float& value : texels) value = unit(random);
  const float trap[] = {0.5f, std::nextafter(0.5f, 0.0f), std::nextafter(0.5f, 1.0f), 0.4981f};
  for (std::size_t i = 0; i < faces * per_face; i += 8) texels[8 * i + 7] = trap[i / 8 % 4];
  texture.texels = std::move(texels);
  texture.mlp = random_mlp(random);
  soup.appearance = std::move(texture);
  Scene scene = scene_of(std::move(soup));
  scene.info.up = {0.0f, 0.6f, -0.8f};
  scene.info.background = {0.25f, 0.5f, 1.0f};
  return scene;
}

const LatticeTexture& texture_of(const Scene& scene) {
  return std::get<LatticeTexture>(only_soup(scene).appearance);
}

void write_text(const fs::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

std::string read_text(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void replace_in(const fs::path& path, const std::string& from, const std::string& to) {
  std::string text = read_text(path);
  const std::size_t at = text.find(from);
  ASSERT_NE(at, std::string::npos) << from << " in " << path;
  write_text(path, text.replace(at, from.size(), to));
}

/// Rewrites the image with the same texels in rows of another width.
void reshape(const fs::path& path, std::size_t texels, int width) {
  Input input = Input::open(path);
  const Image8 image = read_image(input);
  Image8 wide(width, static_cast<int>((texels + std::size_t(width) - 1) / std::size_t(width)));
  std::copy_n(image.pixels.begin(), texels, wide.pixels.begin());
  const auto png = encode_png(wide);
  write_text(path, {reinterpret_cast<const char*>(png.data()), png.size()});
}

std::optional<Refusal> refusal(const fs::path& folder) {
  return error_of([&] { read_diffsoup_export(folder); });
}

class DiffSoupLevel : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(All, DiffSoupLevel, ::testing::Range(0, lattice::max_level + 1));

TEST_P(DiffSoupLevel, RoundTripKeepsValuesToHalfAByteAndTheSideOfEveryAlpha) {
  const TemporaryFolder folder;
  const unsigned seed = 100u + unsigned(GetParam());
  SCOPED_TRACE("seed " + std::to_string(seed));
  const Scene scene = random_scene(seed, 5, GetParam());
  EXPECT_THAT(write_diffsoup_export(scene, folder / "scene"), IsEmpty());
  ASSERT_TRUE(is_diffsoup_export(folder / "scene"));
  const Scene copy = read_diffsoup_export(folder / "scene");
  EXPECT_EQ(defect(only_soup(copy)), std::nullopt);
  EXPECT_EQ(copy.info.name, "scene");
  EXPECT_EQ(copy.info.background, scene.info.background);
  EXPECT_NEAR(glm::distance(copy.info.up, scene.info.up), 0, 1e-6);
  EXPECT_THAT(copy.info.remarks, IsEmpty());
  EXPECT_EQ(only_soup(copy).positions, only_soup(scene).positions);
  EXPECT_EQ(only_soup(copy).triangles, only_soup(scene).triangles);
  const LatticeTexture &before = texture_of(scene), &after = texture_of(copy);
  ASSERT_EQ(before.texel_count(), after.texel_count());
  for (std::size_t i = 0; i < before.texel_count(); ++i) {
    for (int c = 0; c < LatticeTexture::channels; ++c)
      // 6e-8: byte / 255 is a float.
      ASSERT_LE(std::abs(double(before.value(i, c)) - double(after.value(i, c))), 0.5 / 255 + 6e-8);
    ASSERT_EQ(before.value(i, 7) >= 0.5f, after.value(i, 7) >= 0.5f) << before.value(i, 7);
  }
  for (std::size_t l = 0; l < 3; ++l) {
    EXPECT_EQ(before.mlp->layers[l].weights, after.mlp->layers[l].weights);
    EXPECT_EQ(before.mlp->layers[l].biases, after.mlp->layers[l].biases);
  }
  // The second trip starts from bytes, so nothing changes. It replaces an existing folder.
  EXPECT_THAT(write_diffsoup_export(copy, folder / "scene"), IsEmpty());
  EXPECT_EQ(texture_of(read_diffsoup_export(folder / "scene")).texels, after.texels);
}

TEST(DiffSoupExport, AnyWidthOfTheImagesReadsAlike) {
  const TemporaryFolder folder;
  const Scene scene = random_scene(1, 7, 2);  // 105 texels
  write_diffsoup_export(scene, folder / "a");
  const auto expected = texture_of(read_diffsoup_export(folder / "a")).texels;
  for (const int width : {1, 2, 7, 50, 104, 105, 106, 4096}) {
    reshape(folder / "a/lut0.png", 105, width);
    reshape(folder / "a/lut1.png", 105, width == 7 ? 50 : width);
    EXPECT_EQ(texture_of(read_diffsoup_export(folder / "a")).texels, expected) << width;
  }
  reshape(folder / "a/lut1.png", 40, 50);
  EXPECT_THAT(refusal(folder / "a"), ErrorAt("a/lut1.png@16", 50, 1, 105, 3));
}

// Row X3 of the catalogue of numerical hazards: N texels in rows of W take ceil(N / W) rows.
TEST(DiffSoupExport, X3_ATableOfOtherThanTheRowsThatItsTexelsTakeIsRefused) {
  const TemporaryFolder folder;
  const Scene scene = random_scene(1, 7, 2);
  constexpr int texels = 105;
  for (const char* file : {"lut0.png", "lut1.png"})
    for (const int width : {1, 7, 50, 104, 105, 106, 4096}) {
      write_diffsoup_export(scene, folder / "a");
      const int rows = (texels + width - 1) / width;
      for (const int wrong : {rows - 1, rows + 1, 2 * rows}) {
        if (wrong < 1) continue;
        const auto png = encode_png(Image8(width, wrong));
        write_text(folder / (std::string("a/") + file),
                   {reinterpret_cast<const char*>(png.data()), png.size()});
        EXPECT_THAT(refusal(folder / "a"),
                    ErrorAt(std::string(file) + "@16", width, wrong, 105, rows));
      }
      const auto png = encode_png(Image8(width, rows));
      write_text(folder / (std::string("a/") + file),
                 {reinterpret_cast<const char*>(png.data()), png.size()});
      EXPECT_EQ(refusal(folder / "a"), std::nullopt) << width;
    }
}

TEST(DiffSoupExport, TheExactBytesOfTheMesh) {
  const TemporaryFolder folder;
  write_diffsoup_export(random_scene(2, 3, 1), folder / "a");
  const std::string mesh = read_text(folder / "a/mesh.ply");
  const std::string header =
      "ply\nformat binary_little_endian 1.0\nelement vertex 9\nproperty float x\nproperty float y\n"
      "property float z\nelement face 3\nproperty list uchar int vertex_indices\nend_header\n";
  EXPECT_EQ(mesh.substr(0, header.size()), header);
  EXPECT_EQ(mesh.size(), header.size() + 12 * 9 + 13 * 3);
  EXPECT_EQ(mesh.substr(mesh.size() - 13), std::string("\3\6\0\0\0\7\0\0\0\x8\0\0\0", 13));
}

TEST(DiffSoupExport, OtherLayoutsOfTheMeshAreRead) {
  const TemporaryFolder folder;
  const Scene scene = random_scene(3, 1, 0);
  write_diffsoup_export(scene, folder / "a");
  std::string mesh =
      "ply\r\nformat binary_little_endian 1.0\r\ncomment of a tool\r\nelement vertex 3\r\n"
      "property uchar tag\r\nproperty double z\r\nproperty float y\r\nproperty float x\r\n"
      "element face 1\r\nproperty list int ushort vertex_index\r\nproperty float area\r\n"
      "end_header\r\n";
  for (const glm::vec3& p : only_soup(scene).positions) {
    const double z = double(p.z);
    mesh += 'T';
    mesh.append(reinterpret_cast<const char*>(&z), 8);
    mesh.append(reinterpret_cast<const char*>(&p.y), 4);
    mesh.append(reinterpret_cast<const char*>(&p.x), 4);
  }
  mesh += std::string("\3\0\0\0\2\0\0\0\1\0", 10) + "area";
  write_text(folder / "a/mesh.ply", mesh);
  const Scene copy = read_diffsoup_export(folder / "a");
  EXPECT_EQ(only_soup(copy).positions, only_soup(scene).positions);
  EXPECT_EQ(only_soup(copy).triangles[0], glm::uvec3(2, 0, 1));
}

TEST(DiffSoupExport, TheHalfThatTruncationLostIsRestoredAndCounted) {
  const TemporaryFolder folder;
  Scene scene = random_scene(4, 6, 2);  // 90 texels
  auto& texture = std::get<LatticeTexture>(only_soup(scene).appearance);
  std::vector<std::uint8_t> bytes(90 * 8, 200);
  for (std::size_t i = 0; i < 20; ++i) bytes[8 * i + 7] = 127;
  bytes[8 * 30 + 7] = 126;
  bytes[8 * 31 + 7] = 128;
  texture.texels = bytes;
  write_diffsoup_export(scene, folder / "a");
  // A file by this program is read unchanged.
  EXPECT_EQ(texture_of(read_diffsoup_export(folder / "a")).texels, texture.texels);
  // The published exporter writes the same file without our key.
  replace_in(folder / "a/meta.json", "\"tureen\"", "\"another\"");
  Scene copy = read_diffsoup_export(folder / "a");
  EXPECT_THAT(copy.info.remarks,
              Contains(Remark{&remarks::alpha_half_restored, {{"texels", 20}, {"all", 90}}}));
  for (std::size_t i = 0; i < 20; ++i) bytes[8 * i + 7] = 128;
  EXPECT_EQ(std::get<std::vector<std::uint8_t>>(texture_of(copy).texels), bytes);
  // Without a peak at 127, the distribution is smooth and stays unchanged.
  for (std::size_t i = 0; i < 90; ++i) bytes[8 * i + 7] = std::uint8_t(125 + i % 5);
  texture.texels = bytes;
  write_diffsoup_export(scene, folder / "a");
  replace_in(folder / "a/meta.json", "\"tureen\"", "\"another\"");
  copy = read_diffsoup_export(folder / "a");
  EXPECT_THAT(copy.info.remarks, IsEmpty());
  EXPECT_EQ(texture_of(copy).texels, texture.texels);
}

TEST(DiffSoupExport, TransparentTexelsKeepTheirFeatures) {
  const TemporaryFolder folder;
  Scene scene = random_scene(5, 1, 0);
  auto& texture = std::get<LatticeTexture>(only_soup(scene).appearance);
  // Both alpha channels of the images are 0: a premultiplying decoder would lose the other values.
  texture.texels = std::vector<std::uint8_t>{9, 8, 7, 0, 6, 5, 4, 0, 1, 2,   3, 0,
                                             4, 5, 6, 0, 0, 0, 1, 0, 2, 255, 3, 0};
  write_diffsoup_export(scene, folder / "a");
  EXPECT_EQ(texture_of(read_diffsoup_export(folder / "a")).texels, texture.texels);
}

TEST(DiffSoupExport, MixedLevelsBecomeTheHighest) {
  const TemporaryFolder folder;
  Scene scene = random_scene(6, 2, 3);
  auto& texture = std::get<LatticeTexture>(only_soup(scene).appearance);
  texture.patches[1].level = 1;
  EXPECT_THAT(write_diffsoup_export(scene, folder / "a"), Contains(Names(1, 2, 3)));
  const Scene copy = read_diffsoup_export(folder / "a");
  const LatticeTexture& fine = texture_of(copy);
  const int n = lattice::resolution(3);
  for (int y = 0; y <= n; ++y)
    for (int x = 0; x + y <= n; ++x) {
      const auto at = lattice::footprint(1, double(x) / n, double(y) / n);
      for (int c = 0; c < 8; ++c) {
        double expected = 0;
        for (int k = 0; k < 3; ++k)
          expected += at.weights[k] *
                      double(texture.value(texture.patches[1].first_texel + at.texels[k], c));
        const std::size_t texel = fine.patches[1].first_texel + lattice::texel_index(x, y);
        ASSERT_NEAR(double(fine.value(texel, c)), expected, 0.5 / 255 + 1e-7);
      }
    }
}

TEST(DiffSoupExport, PlainColoursBecomeLevelZero) {
  const TemporaryFolder folder;
  TriangleSoup soup{.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}},
                    .triangles = {{0, 1, 2}, {2, 1, 3}},
                    .appearance = VertexColors{
                        {{0, 0, 0, 1}, {0.2f, 0.4f, 0.6f, 1}, {1, 1, 1, 0}, {0.8f, 0, 0, 0.5f}}}};
  Scene scene = scene_of(soup, {10, 20, 30});
  EXPECT_THAT(write_diffsoup_export(scene, folder / "v"), ::testing::SizeIs(2))
      << "a network is added, the origin is moved";
  const Scene vertex = read_diffsoup_export(folder / "v");
  EXPECT_EQ(only_soup(vertex).positions[3], glm::vec3(11, 21, 30));
  // Face 1 is (2, 1, 3); its texels come from its third, first and second vertex.
  EXPECT_EQ(std::get<std::vector<std::uint8_t>>(texture_of(vertex).texels),
            (std::vector<std::uint8_t>{255, 255, 255, 0, 0, 0, 0, 0,    //
                                       0,   0,   0,   0, 0, 0, 0, 255,  //
                                       51,  102, 153, 0, 0, 0, 0, 255,  //
                                       204, 0,   0,   0, 0, 0, 0, 128,  //
                                       255, 255, 255, 0, 0, 0, 0, 0,    //
                                       51,  102, 153, 0, 0, 0, 0, 255}));
  // The network changes nothing: a pixel's colour is its first three features.
  const std::vector<double> features{0.2, 0.4, 0.6, 0, 0, 0, 0};
  const glm::dvec3 color = evaluate(*texture_of(vertex).mlp, features, glm::dvec3(0, 0, 1));
  EXPECT_EQ(color, glm::dvec3(0.2, 0.4, 0.6));

  soup.appearance = FaceColors{{{1, 0, 0, 1}, {0, 0.2f, 0, 1}}};
  only_soup(scene) = soup;
  write_diffsoup_export(scene, folder / "f");
  const Scene face = read_diffsoup_export(folder / "f");
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_EQ(texture_of(face).value(k, 0), k < 3 ? 1.0f : 0.0f);
    EXPECT_EQ(texture_of(face).value(k, 1), k < 3 ? 0.0f : 51.0f / 255.0f);
  }
}

TEST(DiffSoupExport, TheTransformOfALayerIsAppliedIfColoursDoNotDependOnTheView) {
  const TemporaryFolder folder;
  Scene scene = random_scene(7, 2, 0);
  scene.layers[0].world_from_layer[2][2] = -1;
  EXPECT_THAT(error_of<UsageError>([&] { write_diffsoup_export(scene, folder / "a"); }),
              ErrorAt("", "mirrored", "view"));
  EXPECT_FALSE(fs::exists(folder / "a"));
  std::get<LatticeTexture>(only_soup(scene).appearance).mlp.reset();
  EXPECT_THAT(write_diffsoup_export(scene, folder / "a"), Contains(Names("mirror")));
  EXPECT_EQ(only_soup(read_diffsoup_export(folder / "a")).positions[0].z, -2.0f);
}

TEST(DiffSoupExport, WhatItCannotHoldIsRefusedAndLeavesNothing) {
  const TemporaryFolder folder;
  const auto usage_error = [&](const Scene& scene) {
    return error_of<UsageError>([&] { write_diffsoup_export(scene, folder / "a"); });
  };
  Scene scene = random_scene(7, 1, 0);
  auto& soup = only_soup(scene);
  std::get<LatticeTexture>(soup.appearance).mlp->view = ViewConvention::eye_to_surface;
  EXPECT_THAT(usage_error(scene), ErrorAt("", "16-16-16-3"));
  soup.appearance = Harmonics{.coefficients = {glm::vec3(1)}};
  EXPECT_THAT(usage_error(scene), ErrorAt(""));
  soup.appearance = UvTextures{};
  EXPECT_THAT(usage_error(scene_of(Splats{})), ErrorAt(""));
  soup = TriangleSoup{{}, {}, FaceColors{}};
  EXPECT_THAT(usage_error(scene), ErrorAt(""));
  EXPECT_FALSE(fs::exists(folder / "a"));

  // The writer does not touch a folder with other files.
  fs::create_directory(folder / "b");
  write_text(folder / "b/diary.txt", "dear");
  EXPECT_THROW(write_diffsoup_export(random_scene(7, 1, 0), folder / "b"), OutputError);
  EXPECT_THROW(write_diffsoup_export(random_scene(7, 1, 0), folder / "absent/b"), OutputError);
  EXPECT_EQ(read_text(folder / "b/diary.txt"), "dear");
  std::size_t entries = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator(folder / "")) ++entries;
  EXPECT_EQ(entries, 1u) << "a temporary folder remains";
}

TEST(DiffSoupExport, WhatIsWrongIsNamed) {
  const TemporaryFolder folder;
  const auto changed = [&](const char* file, const std::string& from, const std::string& to) {
    write_diffsoup_export(random_scene(8, 2, 1), folder / "a");
    replace_in(folder / (std::string("a/") + file), from, to);
    return refusal(folder / "a");
  };
  EXPECT_THAT(changed("meta.json", "\"level\": 1", "\"level\": 8"),
              ErrorAt("a/meta.json", "level", 7));
  EXPECT_THAT(changed("meta.json", "\"level\": 1", "\"level\": 5"),
              ErrorAt("a/lut0.png@16", 12, 1, 1122));
  EXPECT_THAT(changed("meta.json", "\"num_faces\": 2", "\"num_faces\": 3"),
              ErrorAt("a/mesh.ply", 2, "meta.json", 3));
  EXPECT_THAT(changed("meta.json", "\"up\": [", "\"up\": [1,"), ErrorAt("a/meta.json", "up", 3));
  EXPECT_THAT(changed("meta.json", "{", "{,"), ErrorAt("a/meta.json@1"));
  EXPECT_THAT(changed("mlp_weights.json", "\"W1\"", "\"W9\""), ErrorAt("a/mlp_weights.json", "W1"));
  EXPECT_THAT(changed("mlp_weights.json", "\"b3\":[", "\"b3\":[1e999,"),
              ErrorAt("a/mlp_weights.json@11992"));
  EXPECT_THAT(changed("mlp_weights.json", "\"b3\":[", "\"b3\":[1,"),
              ErrorAt("a/mlp_weights.json", "b3", 3, 4));
  EXPECT_THAT(changed("mlp_weights.json", "\"b3\":[", "\"b3\":[\"x\",1,2],\"b4\":["),
              ErrorAt("a/mlp_weights.json", "b3[0]"));
  EXPECT_THAT(changed("mesh.ply", "vertex 6", "vertex 9999999999"),
              ErrorAt("a/mesh.ply:3", "9999999999"));
  EXPECT_THAT(changed("mesh.ply", "face 2", "face 3"), ErrorAt("a/mesh.ply@241", 3));
  EXPECT_THAT(changed("mesh.ply", "little", "big"), ErrorAt("a/mesh.ply", "binary_big_endian"));
  EXPECT_THAT(changed("mesh.ply", "float x", "list uchar float x"),
              ErrorAt("a/mesh.ply:3", "list"));
  EXPECT_THAT(changed("mesh.ply", "element face", "element edge"), ErrorAt("a/mesh.ply:1", "face"));
  EXPECT_THAT(changed("mesh.ply", "uchar int vertex", "uchar float vertex"),
              ErrorAt("a/mesh.ply:7", "vertex_indices"));
  EXPECT_THAT(changed("mesh.ply", "float x", "float q"), ErrorAt("a/mesh.ply:3"));
  EXPECT_THAT(changed("mesh.ply", std::string("\3\0\0\0\0", 5), std::string("\3\x6\0\0\0", 5)),
              ErrorAt("a/mesh.ply@241", 0, 6));
  EXPECT_THAT(changed("mesh.ply", std::string("\3\0\0\0\0", 5), std::string("\4\0\0\0\0", 5)),
              ErrorAt("a/mesh.ply@241", 0, 4));
  EXPECT_THAT(changed("lut0.png", "IHDR", "IHDX"), ErrorAt("a/lut0.png@8"));
  write_diffsoup_export(random_scene(8, 2, 1), folder / "a");
  fs::remove(folder / "a/mlp_weights.json");
  EXPECT_THAT(refusal(folder / "a"), ErrorAt("a/mlp_weights.json"));
  fs::remove(folder / "a/lut0.png");
  EXPECT_FALSE(is_diffsoup_export(folder / "a"));
  EXPECT_FALSE(is_diffsoup_export(folder / "a/mesh.ply"));
}

TEST(DiffSoupExport, AHeaderThatOnlyLooksLikeOneIsRefused) {
  // A PNG with Apple's chunk CgBI first, which the decoder skips. Its content imitates a header
  // with all texels. The true header, with one pixel, follows. After that chunk, deflated data has
  // no zlib header, which is two bytes.
  const TemporaryFolder folder;
  write_diffsoup_export(random_scene(12, 40, 3), folder / "a");
  const fs::path path = folder / "a/lut1.png";
  const std::string promised = read_text(path).substr(16, 10);  // width, height, depth, colours
  const auto bytes = encode_png(Image8(1, 1));
  std::string small(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::size_t data = small.find("IDAT");
  small[data - 1] = char(small[data - 1] - 2);
  small.erase(data + 4, 2);
  const std::string odd =
      small.substr(0, 8) + std::string("\0\0\0\012CgBI", 8) + promised + "CRC." + small.substr(8);
  const auto odd_bytes = std::as_bytes(std::span(odd));
  write_file(path, test::with_png_sums({odd_bytes.begin(), odd_bytes.end()}));
  Input input = Input::open(path);
  ASSERT_EQ(read_image(input).width, 1) << "the decoder no longer skips the chunk";
  EXPECT_THAT(refusal(folder / "a"), ErrorAt("a/lut1.png@8"));
}

TEST(DiffSoupExport, ALinkInARingIsRefusedWithASentence) {
  const TemporaryFolder folder;
  write_diffsoup_export(random_scene(13, 2, 1), folder / "a");
  fs::remove(folder / "a/meta.json");
  fs::create_symlink("meta.json", folder / "a/meta.json");
  EXPECT_THAT(refusal(folder / "a"), ErrorAt("a/meta.json"));
}

TEST(DiffSoupExport, WithoutMetaTheViewersDefaultsHold) {
  const TemporaryFolder folder;
  write_diffsoup_export(random_scene(9, 2, 5), folder / "a");
  fs::remove(folder / "a/meta.json");
  const Scene scene = read_diffsoup_export(folder / "a");
  EXPECT_EQ(texture_of(scene).patches[1].level, 5u);
  EXPECT_EQ(scene.info.up, glm::vec3(0, -1, 0));
  EXPECT_EQ(scene.info.background, glm::vec3(0));
  EXPECT_TRUE(scene.info.up_is_assumed);
  EXPECT_THAT(scene.info.remarks, Contains(Remark{&remarks::meta_missing}));
}

TEST(DiffSoupExport, AnImageOfAnotherLevelThanWasAssumedIsRefusedByThat) {
  const TemporaryFolder folder;
  write_diffsoup_export(random_scene(9, 2, 3), folder / "a");
  write_text(folder / "a/meta.json", "{}");
  EXPECT_THAT(refusal(folder / "a"), ErrorAt("a/lut0.png@16", "meta.json", 5));
  fs::remove(folder / "a/meta.json");
  EXPECT_THAT(refusal(folder / "a"), ErrorAt("a/lut0.png@16", "meta.json", 5));
}

class DiffSoupDamage : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Files, DiffSoupDamage,
                         ::testing::Values("mesh.ply", "lut0.png", "lut1.png", "mlp_weights.json",
                                           "meta.json"),
                         [](const auto& instance) {
                           const std::string name = instance.param;
                           return name.substr(0, name.find_first_of("._"));
                         });

TEST_P(DiffSoupDamage, TruncationAndDamageAreSurvived) {
  const TemporaryFolder folder;
  Scene scene = random_scene(10, 2, 0);
  // Without the network, whose numbers are zeros, the file is short.
  std::get<LatticeTexture>(only_soup(scene).appearance).mlp.reset();
  write_diffsoup_export(scene, folder / "a");
  const fs::path path = folder / (std::string("a/") + GetParam());
  const std::string good = read_text(path);
  const auto expected = texture_of(read_diffsoup_export(folder / "a")).texels;
  bool same = true;
  const auto read = [&](std::span<const std::byte> bytes) {
    write_text(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    const Scene copy = read_diffsoup_export(folder / "a");
    EXPECT_EQ(defect(only_soup(copy)), std::nullopt);
    same = same && texture_of(copy).texels == expected;
  };
  // The test writes each version to disk: every length and byte of short files, 400 of the long
  // one. DiffSoupMesh below damages the mesh in every way.
  const std::size_t step = 1 + good.size() / 400;
  test::Survival cut;
  for (std::size_t length = 0; length < good.size(); length += step)
    test::expect_survival(std::as_bytes(std::span(good)).first(length), read,
                          "cut to " + std::to_string(length), cut);
  // Every byte is needed except a JSON's last line break and the checksum of a PNG's last chunk.
  EXPECT_LE(cut.read, 4u);
  EXPECT_TRUE(same) << "a truncated file was read with other texels";
  test::Survival damaged;
  for (std::size_t i = 0; i < good.size(); i += step) {
    std::string bad = good;
    bad[i] = static_cast<char>(~bad[i]);
    test::expect_survival(std::as_bytes(std::span(bad)), read, "byte " + std::to_string(i),
                          damaged);
  }
  EXPECT_GT(damaged.refused, 0u);
}

TEST(DiffSoupMesh, TruncationAndDamageAreSurvived) {
  const TemporaryFolder folder;
  write_diffsoup_export(random_scene(11, 2, 0), folder / "a");
  const std::string good = read_text(folder / "a/mesh.ply");
  const auto read = [](std::span<const std::byte> bytes) {
    Input input = Input::memory("mesh.ply", bytes);
    const DiffSoupMesh mesh = read_diffsoup_mesh(input);
    for (const glm::uvec3& triangle : mesh.triangles)
      for (int k = 0; k < 3; ++k) EXPECT_LT(triangle[k], mesh.positions.size());
  };
  EXPECT_EQ(test::survive_truncation(std::as_bytes(std::span(good)), read).read, 0u);
  EXPECT_GT(test::survive_damage(std::as_bytes(std::span(good)), read).refused, 1000u);
}

}  // namespace diffsoup_export_test
}  // namespace tureen
