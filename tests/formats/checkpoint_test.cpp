#include "formats/torch/checkpoint.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <random>

#include "formats/common/format_remarks.hpp"
#include "formats/torch/checkpoint_remarks.hpp"
#include "scene/lattice.hpp"
#include "tests/formats/torch_fixture.hpp"
#include "tests/formats/truncation.hpp"
#include "tests/support/errors.hpp"

namespace tureen {
namespace checkpoint_test {

using test::as_bytes;
using test::error_of;
using test::ErrorAt;
using test::Refusal;
using test::TensorFixture;
using test::TorchFixture;

Scene read(const TorchFixture& fixture) {
  const std::string bytes = fixture.bytes();
  return read_checkpoint(Input::memory("scene.pt", as_bytes(bytes)));
}

std::optional<Refusal> refusal(const TorchFixture& fixture) {
  return error_of([&] { read(fixture); });
}

std::vector<float> ramp(std::size_t count, float start = 0.0f, float step = 0.001f) {
  std::vector<float> values(count);
  for (std::size_t i = 0; i < count; ++i) values[i] = start + step * float(i);
  return values;
}

/// The tensors of a DiffSoup checkpoint with two faces; tests replace one.
struct DiffSoup {
  int level;
  std::uint64_t texels = lattice::texel_count(level);
  TensorFixture features = TensorFixture::floats({2, texels, 7}, ramp(2 * texels * 7, 0.0f, 1e-6f));
  TensorFixture alpha = TensorFixture::floats({2, texels, 1}, ramp(2 * texels, 0.25f, 1e-5f));
  TensorFixture vertices = TensorFixture::floats({4, 3}, ramp(12));
  TensorFixture faces = TensorFixture::ints({2, 3}, {0, 1, 2, 2, 1, 3});
  TensorFixture weight0 = TensorFixture::floats({16, 16}, ramp(256, -0.1f));
  int rmax = level;
  bool flip_z = false;

  TorchFixture file() const {
    TorchFixture torch;
    torch.add("feat_acc", features).add("alpha_acc", alpha).add("V", vertices).add("F", faces);
    torch.add("color_mlp", {{"mlp.0.weight", weight0},
                            {"mlp.0.bias", TensorFixture::floats({16}, ramp(16, 0.5f))},
                            {"mlp.2.weight", TensorFixture::floats({16, 16}, ramp(256, -0.2f))},
                            {"mlp.2.bias", TensorFixture::floats({16}, ramp(16))},
                            {"mlp.4.weight", TensorFixture::floats({3, 16}, ramp(48, 0.3f))},
                            {"mlp.4.bias", TensorFixture::floats({3}, ramp(3, 0.7f))}});
    torch.add("Rmax", rmax).add("losses", 0.125);
    if (flip_z) torch.add("flip_z", 1);
    return torch;
  }
};

TEST(Checkpoint, IsToldByItsFirstBytes) {
  EXPECT_TRUE(is_checkpoint(as_bytes(DiffSoup{0}.file().bytes())));
  EXPECT_TRUE(is_checkpoint(as_bytes("\x80\x02\x8a\x0a\x6c\xfc\x9c\x46")));
  EXPECT_FALSE(is_checkpoint(as_bytes("PK\5\6")));
  EXPECT_FALSE(is_checkpoint(as_bytes("ply\n")));
  EXPECT_FALSE(is_checkpoint({}));
}

TEST(Checkpoint, DiffSoupAtEveryLevel) {
  for (int level = 0; level <= lattice::max_level; ++level) {
    const DiffSoup diffsoup{level};
    Scene scene = read(diffsoup.file());
    const auto& soup = only_soup(scene);
    ASSERT_EQ(defect(soup), std::nullopt);
    EXPECT_EQ(scene.info.source, "DiffSoup checkpoint");
    ASSERT_EQ(soup.triangles.size(), 2u);
    EXPECT_EQ(soup.triangles[1], glm::uvec3(2, 1, 3));
    EXPECT_EQ(soup.positions[3], glm::vec3(0.001f * 9, 0.001f * 10, 0.001f * 11));
    const auto& texture = std::get<LatticeTexture>(soup.appearance);
    EXPECT_TRUE(texture.is_float());
    const std::size_t count = lattice::texel_count(level);
    ASSERT_EQ(texture.texel_count(), 2 * count);
    EXPECT_EQ(texture.patches[1].first_texel, count);
    EXPECT_EQ(texture.patches[1].level, unsigned(level));
    for (std::size_t texel = 0; texel < 2 * count; ++texel) {
      for (int c = 0; c < 7; ++c)
        ASSERT_EQ(texture.value(texel, c), 1e-6f * float(texel * 7 + std::size_t(c)));
      ASSERT_EQ(texture.value(texel, 7), 0.25f + 1e-5f * float(texel));
    }
  }
}

TEST(Checkpoint, DiffSoupMlpAndScene) {
  Scene scene = read(DiffSoup{1}.file());
  const auto& mlp = *std::get<LatticeTexture>(only_soup(scene).appearance).mlp;
  // [out][in], row by row.
  EXPECT_EQ(mlp.layers[0].weights[3 * 16 + 5], -0.1f + 0.001f * 53);
  EXPECT_EQ(mlp.layers[2].weights[2 * 16 + 1], 0.3f + 0.001f * 33);
  EXPECT_EQ(mlp.layers[2].biases[1], 0.7f + 0.001f * 1);
  EXPECT_EQ(mlp.encoding, DirectionEncoding::harmonics2);
  EXPECT_EQ(mlp.view, ViewConvention::surface_to_eye);
  EXPECT_EQ(mlp.blend_channel, 3);
  EXPECT_EQ(scene.info.up, glm::vec3(0, 0, 1));
  EXPECT_EQ(scene.info.background, glm::vec3(1));

  DiffSoup real{1};
  real.flip_z = true;
  scene = read(real.file());
  EXPECT_EQ(scene.info.up, glm::vec3(0, -1, 0));
  EXPECT_EQ(scene.info.background, glm::vec3(0));
}

TEST(Checkpoint, StridesOffsetsAndParametersAreHonoured) {
  DiffSoup diffsoup{0};
  // Vertices column by column, after two unused numbers.
  diffsoup.vertices = TensorFixture::floats({4, 3}, ramp(14));
  diffsoup.vertices.strides = {1, 4};
  diffsoup.vertices.offset = 2;
  diffsoup.vertices.parameter = true;
  Scene scene = read(diffsoup.file());
  const auto& positions = only_soup(scene).positions;
  for (int v = 0; v < 4; ++v)
    for (int k = 0; k < 3; ++k)
      EXPECT_EQ(positions[std::size_t(v)][k], 0.001f * float(2 + v + 4 * k));
}

TEST(Checkpoint, NumbersOfEveryType) {
  DiffSoup diffsoup{0};
  const auto x = [&](TensorFixture vertices) {
    diffsoup.vertices = std::move(vertices);
    return only_soup(read(diffsoup.file())).positions;
  };
  // 0, 1, -2, the smallest denormal, 65504 and a third in IEEE binary16.
  const std::vector<std::uint16_t> halves{0, 0x3c00, 0xc000, 1, 0x7bff, 0x3555, 0, 0, 0, 0, 0, 0};
  const auto from_half = x(TensorFixture::of("HalfStorage", {4, 3}, halves));
  EXPECT_EQ(from_half[0], glm::vec3(0, 1, -2));
  EXPECT_EQ(from_half[1], glm::vec3(std::ldexp(1.0f, -24), 65504, 0.333251953125f));
  const std::vector<std::uint16_t> brains{0x3f80, 0xc000, 0x3eab, 0, 0, 0, 0, 0, 0, 0, 0, 0};
  EXPECT_EQ(x(TensorFixture::of("BFloat16Storage", {4, 3}, brains))[0],
            glm::vec3(1, -2, 0.333984375f));
  EXPECT_EQ(x(TensorFixture::of("DoubleStorage", {4, 3}, std::vector<double>(12, 0.1)))[0].x, 0.1f);
  EXPECT_EQ(x(TensorFixture::of("ShortStorage", {4, 3}, std::vector<std::int16_t>(12, -5)))[0].x,
            -5.0f);
  EXPECT_EQ(x(TensorFixture::of("CharStorage", {4, 3}, std::vector<std::int8_t>(12, -5)))[0].x,
            -5.0f);
  EXPECT_EQ(x(TensorFixture::of("ByteStorage", {4, 3}, std::vector<std::uint8_t>(12, 250)))[0].x,
            250.0f);
  diffsoup.faces =
      TensorFixture::of("LongStorage", {2, 3}, std::vector<std::int64_t>{0, 1, 2, 2, 1, 3});
  EXPECT_EQ(only_soup(read(diffsoup.file())).triangles[1], glm::uvec3(2, 1, 3));
}

TEST(Checkpoint, DeflatedAndZip64ArchivesReadAlike) {
  const Scene plain = read(DiffSoup{2}.file());
  TorchFixture torch = DiffSoup{2}.file();
  torch.deflate = torch.zip64 = true;
  const Scene packed = read(torch);
  const auto texels = [](const Scene& scene) {
    return std::get<LatticeTexture>(only_soup(scene).appearance).texels;
  };
  EXPECT_EQ(texels(plain), texels(packed));
}

TEST(Checkpoint, WhatDoesNotFitIsRefusedByName) {
  const auto changed = [](auto&& change) {
    DiffSoup diffsoup{1};
    change(diffsoup);
    return refusal(diffsoup.file());
  };
  EXPECT_EQ(changed([](DiffSoup&) {}), std::nullopt);
  EXPECT_THAT(changed([](DiffSoup& d) { d.rmax = 5; }), ErrorAt("scene.pt", "Rmax", 5));
  EXPECT_THAT(changed([](DiffSoup& d) {
                d.features = TensorFixture::floats({2, 5, 7}, ramp(70));
                d.alpha = TensorFixture::floats({2, 5, 1}, ramp(10));
              }),
              ErrorAt("scene.pt", "feat_acc", 5));
  EXPECT_THAT(changed([](DiffSoup& d) {
                d.alpha.shape = {2, 6};
              }),
              ErrorAt("scene.pt: archive/data.pkl@334", "alpha_acc", "[2, 6]", "[2, 6, 1]"));
  EXPECT_THAT(changed([](DiffSoup& d) {
                d.vertices.shape = {5, 3};
              }),
              ErrorAt("scene.pt: archive/data.pkl@497", "V", "[5, 3]", 12));
  EXPECT_THAT(changed([](DiffSoup& d) { d.vertices.offset = 1; }),
              ErrorAt("scene.pt: archive/data.pkl@497", "V"));
  EXPECT_THAT(changed([](DiffSoup& d) {
                d.vertices.strides = {4, 1};
              }),
              ErrorAt("scene.pt: archive/data.pkl@497", "V"));
  EXPECT_THAT(changed([](DiffSoup& d) { d.vertices.type = "ComplexFloatStorage"; }),
              ErrorAt("scene.pt: archive/data.pkl@398", "torch.ComplexFloatStorage"));
  EXPECT_THAT(changed([](DiffSoup& d) { d.vertices.element = 1; }),
              ErrorAt("scene.pt: archive/data.pkl@497", 48, "archive/data/2"));
  EXPECT_THAT(changed([](DiffSoup& d) {
                d.faces = TensorFixture::ints({2, 3}, {0, 1, 2, 2, 1, 4});
              }),
              ErrorAt("scene.pt", 1, 4));
  EXPECT_THAT(changed([](DiffSoup& d) {
                d.faces = TensorFixture::ints({1, 3}, {0, 1, 2});
              }),
              ErrorAt("scene.pt", "F", 1, "feat_acc", 2));
  EXPECT_THAT(changed([](DiffSoup& d) {
                d.faces = TensorFixture::floats({2, 3}, ramp(6));
              }),
              ErrorAt("scene.pt: archive/data.pkl@650", "F"));
  EXPECT_THAT(changed([](DiffSoup& d) {
                d.features = TensorFixture::floats({2, 6, 7}, ramp(84, 1));
              }),
              ErrorAt("scene.pt", "feat_acc", "1.001000"));
  EXPECT_THAT(changed([](DiffSoup& d) {
                d.alpha = TensorFixture::floats({2, 6, 1}, std::vector<float>(12, NAN));
              }),
              ErrorAt("scene.pt", "alpha_acc", "nan"));
  EXPECT_THAT(changed([](DiffSoup& d) {
                d.weight0 = TensorFixture::floats({16, 16}, std::vector<float>(256, INFINITY));
              }),
              ErrorAt("scene.pt"));
  EXPECT_THAT(changed([](DiffSoup& d) {
                d.weight0.shape = {8, 32};
              }),
              ErrorAt("scene.pt: archive/data.pkl@854", "mlp.0.weight", "[8, 32]", "[16, 16]"));
  EXPECT_THAT(refusal(TorchFixture().add("V", 1)), ErrorAt("scene.pt"));
  EXPECT_THAT(refusal(TorchFixture().add("feat_acc", 1)), ErrorAt("scene.pt", "V"));
  EXPECT_THAT(refusal(TorchFixture().add("feat_acc", 1).add("V", 1)),
              ErrorAt("scene.pt: archive/data.pkl@28", "V"));
  const std::string old = "\x80\x02\x8a\x0a\x6c\xfc";
  EXPECT_THROW(read_checkpoint(Input::memory("old.pt", as_bytes(old))), InputError);
}

TorchFixture triangle_splatting(int degree, std::uint64_t rest) {
  TorchFixture torch;
  const auto parameter = [](TensorFixture tensor) {
    tensor.parameter = true;
    return tensor;
  };
  torch.add("triangles_points", parameter(TensorFixture::floats({2, 3, 3}, ramp(18))));
  torch.add("sigma", parameter(TensorFixture::floats({2, 1}, {0.25f, -3.0f})));
  torch.add("active_sh_degree", degree);
  torch.add("features_dc", parameter(TensorFixture::floats({2, 1, 3}, ramp(6, 5))));
  torch.add("features_rest", parameter(TensorFixture::floats({2, rest, 3}, ramp(6 * rest, 7))));
  torch.add("opacity", parameter(TensorFixture::floats({2, 1}, {-2.0f, 4.0f})));
  return torch;
}

TEST(Checkpoint, TriangleSplattingIsActivated) {
  const Scene scene = read(triangle_splatting(2, 15));
  const auto& splats = std::get<Splats>(only_layer(scene).primitives);
  const auto& windows = std::get<TriangleWindows>(splats.kernel);
  const SplatColor& color = splats.color;
  EXPECT_EQ(name_of(splats.profile), "triangle-splatting");
  ASSERT_EQ(windows.corners.size(), 6u);
  EXPECT_EQ(windows.corners[5], glm::vec3(0.001f * 15, 0.001f * 16, 0.001f * 17));
  EXPECT_FLOAT_EQ(windows.sigma[0], float(0.01 + std::exp(0.25)));
  EXPECT_FLOAT_EQ(windows.sigma[1], float(0.01 + std::exp(-3.0)));
  EXPECT_FLOAT_EQ(windows.opacity[0], float(1 / (1 + std::exp(2.0))));
  EXPECT_EQ(color.degree, 2);
  // Nine coefficients a triangle of the sixteen that are stored.
  ASSERT_EQ(color.coefficients.size(), 18u);
  EXPECT_EQ(color.coefficients[9], glm::vec3(5 + 0.001f * 3, 5 + 0.001f * 4, 5 + 0.001f * 5));
  EXPECT_EQ(color.coefficients[10].x, 7 + 0.001f * 45);
  EXPECT_EQ(color.coefficients[17].z, 7 + 0.001f * (45 + 23));
  EXPECT_EQ(scene.info.up, glm::vec3(0, -1, 0));
  EXPECT_TRUE(scene.info.up_is_assumed);
  EXPECT_THAT(scene.info.remarks, ::testing::Contains(Remark{&remarks::up_unknown_to_checkpoint}));

  EXPECT_EQ(std::get<Splats>(only_layer(read(triangle_splatting(0, 15))).primitives)
                .color.coefficients.size(),
            2u);
  EXPECT_THAT(refusal(triangle_splatting(3, 8)), ErrorAt("scene.pt", 8));
  TorchFixture none;
  none.add("triangles_points", TensorFixture::floats({0, 3, 3}, {}));
  none.add("sigma", TensorFixture::floats({2, 1}, {1, 1}));
  none.add("opacity", TensorFixture::floats({2, 1}, {1, 1}));
  EXPECT_THAT(refusal(none),
              ErrorAt("scene.pt: archive/data.pkl@338", "sigma", "[2, 1]", "[0, 1]"));
  EXPECT_THAT(refusal(triangle_splatting(5, 15)), ErrorAt("scene.pt", "active_sh_degree", 5));
}

/// Two triangles of Triangle Splatting+ with four vertices; tests replace a part.
struct Connected {
  TensorFixture points = TensorFixture::floats({4, 3}, ramp(12));
  TensorFixture indices = TensorFixture::ints({2, 3}, {0, 1, 2, 2, 1, 3});
  TensorFixture weights = TensorFixture::floats({4, 1}, {3, 1, 2, -1});
  double sigma = -9.2;
  TensorFixture constant = TensorFixture::floats({4, 1, 3}, ramp(12));

  TorchFixture file() const {
    TorchFixture torch;
    torch.add("triangles_points", points).add("_triangle_indices", indices);
    torch.add("vertex_weight", weights).add("sigma", sigma).add("active_sh_degree", 1);
    torch.add("features_dc", constant);
    torch.add("features_rest", TensorFixture::floats({4, 15, 3}, ramp(180, 1)));
    return torch;
  }
};

const Splats& only_splats(const Scene& scene) {
  return std::get<Splats>(only_layer(scene).primitives);
}

TEST(Checkpoint, ConnectedTrianglesHaveColoursOfCorners) {
  TorchFixture torch = Connected().file();
  const Scene scene = read(torch);
  const Splats& splats = only_splats(scene);
  ASSERT_EQ(defect(splats), std::nullopt);
  EXPECT_EQ(profile_name(splats), "triangle-splatting");
  const auto& windows = std::get<TriangleWindows>(splats.kernel);
  const glm::vec3 third(0.001f * 9, 0.001f * 10, 0.001f * 11);
  EXPECT_EQ(windows.corners.size(), 6u);
  EXPECT_EQ(windows.corners[5], third);
  EXPECT_EQ(windows.sigma, std::vector<float>(2, float(std::exp(-9.2))));
  EXPECT_EQ(windows.opacity[0], float(0.9999 + 0.0001 / (1 + std::exp(-1.0))));
  EXPECT_EQ(windows.opacity[1], float(0.9999 + 0.0001 / (1 + std::exp(1.0))));
  EXPECT_TRUE(splats.color.per_corner);
  EXPECT_EQ(splats.color.degree, 1);
  // Four coefficients a corner of the sixteen that are stored.
  ASSERT_EQ(splats.color.coefficients.size(), 24u);
  EXPECT_EQ(splats.color.coefficients[5 * 4], third);
  EXPECT_EQ(splats.color.coefficients[5 * 4 + 3].z, 1 + 0.001f * (135 + 8));
  EXPECT_EQ(splats.color.coefficients[3 * 4 + 1].x, 1 + 0.001f * 90);
  EXPECT_EQ(scene.info.source, "Triangle Splatting+ checkpoint");
  EXPECT_THAT(scene.info.remarks,
              ::testing::ElementsAre(Remark{&remarks::up_unknown_to_checkpoint}));

  const Scene mesh = read(torch.add("pixel_count", 1));
  EXPECT_EQ(mesh.info.source, "MeshSplatting checkpoint");
  EXPECT_EQ(profile_name(only_splats(mesh)), "mesh-splatting");
  EXPECT_EQ(std::get<TriangleWindows>(only_splats(mesh).kernel).opacity[1],
            float(0.999 + 0.001 / (1 + std::exp(1.0))));
}

TEST(Checkpoint, FalseConnectedTrianglesAreRefused) {
  const auto changed = [](auto change) {
    Connected connected;
    change(connected);
    return refusal(connected.file());
  };
  EXPECT_THAT(changed([](Connected& c) { c.indices.storage[20] = 4; }),
              ErrorAt("scene.pt", "_triangle_indices", 1, 4));
  EXPECT_THAT(changed([](Connected& c) {
                c.weights.shape = {1, 4};
              }),
              ErrorAt("scene.pt: archive/data.pkl@503", "vertex_weight", "[1, 4]", "[4, 1]"));
  EXPECT_THAT(changed([](Connected& c) {
                c.constant.shape = {1, 4, 3};
              }),
              ErrorAt("scene.pt: archive/data.pkl@721", "features_dc", "[1, 4, 3]", "[4, 1, 3]"));
  for (const double sigma : {-800.0, 100.0, double(NAN)})
    EXPECT_THAT(changed([&](Connected& c) { c.sigma = sigma; }), ErrorAt("scene.pt", "sigma"));
  TorchFixture text;
  text.add("triangles_points", Connected().points).add("_triangle_indices", Connected().indices);
  text.add("sigma", Connected().weights);
  EXPECT_THAT(refusal(text), ErrorAt("scene.pt: archive/data.pkl@495", "sigma", "number"));
}

TEST(Checkpoint, WindowsWithoutFiniteValuesAreDropped) {
  const auto set = [](TensorFixture& tensor, std::size_t i, float value) {
    std::memcpy(&tensor.storage[4 * i], &value, 4);
  };
  const auto expect_second_dropped = [](const Connected& connected) {
    const Scene scene = read(connected.file());
    EXPECT_EQ(defect(only_splats(scene)), std::nullopt);
    EXPECT_EQ(count(only_splats(scene)), 1u);
    EXPECT_EQ(std::get<TriangleWindows>(only_splats(scene).kernel).corners[1],
              glm::vec3(0.001f * 3, 0.001f * 4, 0.001f * 5));
    EXPECT_THAT(scene.info.remarks, ::testing::Contains(Remark{&remarks::splats_dropped,
                                                               {{"dropped", 1}, {"all", 2}}}));
  };
  Connected connected;
  set(connected.points, 10, INFINITY);
  expect_second_dropped(connected);
  connected = {};
  set(connected.weights, 3, NAN);
  expect_second_dropped(connected);
  connected = {};
  set(connected.constant, 11, NAN);
  expect_second_dropped(connected);

  TorchFixture soft;
  soft.add("triangles_points", TensorFixture::floats({4, 3, 3}, ramp(36)));
  soft.add("sigma", TensorFixture::floats({4, 1}, {0, NAN, 0, 1000}));
  soft.add("opacity", TensorFixture::floats({4, 1}, {NAN, 0, -INFINITY, 0}));
  soft.add("active_sh_degree", 0);
  soft.add("features_dc", TensorFixture::floats({4, 1, 3}, ramp(12)));
  const Scene scene = read(soft);
  const auto& windows = std::get<TriangleWindows>(only_splats(scene).kernel);
  EXPECT_EQ(windows.opacity, std::vector<float>{0});
  EXPECT_EQ(windows.corners[0].x, 0.001f * 18);
  EXPECT_EQ(only_splats(scene).color.coefficients[0].x, 0.001f * 6);
  EXPECT_THAT(scene.info.remarks,
              ::testing::Contains(Remark{&remarks::splats_dropped, {{"dropped", 3}, {"all", 4}}}));
}

/// Vector `i` of a parameter by data/write_checkpoints.py.
glm::vec3 of_parameter(float start, float step, std::size_t i) {
  const auto number = [&](std::size_t k) { return start + step * float(89 * k * k % 257); };
  return {number(3 * i), number(3 * i + 1), number(3 * i + 2)};
}

const std::filesystem::path checkpoints = TUREEN_SOURCE_DIR "/tests/formats/data";

/// The place of a value that occurs once. Readers sort windows.
std::size_t place_of(const std::vector<float>& values, float value) {
  EXPECT_EQ(std::count(values.begin(), values.end(), value), 1);
  return std::size_t(std::find(values.begin(), values.end(), value) - values.begin());
}

// The next three files were written by torch: data/write_checkpoints.py.

TEST(Checkpoint, OfTriangleSplattingByTorchIsRead) {
  const Scene scene = read_checkpoint(checkpoints / "triangle_splatting.pt");
  const Splats& splats = only_splats(scene);
  ASSERT_EQ(defect(splats), std::nullopt);
  const auto& windows = std::get<TriangleWindows>(splats.kernel);
  ASSERT_EQ(windows.opacity.size(), 6u);
  EXPECT_EQ(splats.color.degree, 3);
  EXPECT_FALSE(splats.color.per_corner);
  for (std::size_t i = 0; i < 6; ++i) {
    const double s = -3 + 0.5 * double(i), o = -4 + 1.5 * double(i);
    const std::size_t at = place_of(windows.sigma, float(0.01 + std::exp(s)));
    EXPECT_EQ(windows.opacity[at], float(1 / (1 + std::exp(-o))));
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_EQ(windows.corners[3 * at + k], of_parameter(-2, 1 / 64.0f, 3 * i + k));
    EXPECT_EQ(splats.color.coefficients[16 * at], of_parameter(-1, 1 / 128.0f, i));
    for (std::size_t k = 0; k < 15; ++k)
      EXPECT_EQ(splats.color.coefficients[16 * at + 1 + k],
                of_parameter(-1 / 8.0f, 1 / 1024.0f, 15 * i + k));
  }
}

void expect_connected(const Scene& scene, double opacity_floor, int degree) {
  const Splats& splats = only_splats(scene);
  ASSERT_EQ(defect(splats), std::nullopt);
  const auto& windows = std::get<TriangleWindows>(splats.kernel);
  EXPECT_EQ(windows.sigma, std::vector<float>(3, float(std::exp(std::log(1e-4)))));
  EXPECT_EQ(splats.color.degree, degree);
  EXPECT_TRUE(splats.color.per_corner);
  const std::size_t vertices[] = {0, 1, 2, 2, 1, 3, 3, 4, 2};
  const double least_weights[] = {0, -1, -2};
  ASSERT_EQ(windows.corners.size(), std::size(vertices));
  const auto each = std::size_t((degree + 1) * (degree + 1));
  for (std::size_t i = 0; i < 9; ++i) {
    const double opacity =
        opacity_floor + (1 - opacity_floor) / (1 + std::exp(-least_weights[i / 3]));
    const std::size_t corner = 3 * place_of(windows.opacity, float(opacity)) + i % 3;
    const std::size_t vertex = vertices[i];
    EXPECT_EQ(windows.corners[corner], of_parameter(-2, 1 / 64.0f, vertex));
    EXPECT_EQ(splats.color.coefficients[each * corner], of_parameter(-1, 1 / 128.0f, vertex));
    for (std::size_t k = 1; k < each; ++k)
      EXPECT_EQ(splats.color.coefficients[each * corner + k],
                of_parameter(-1 / 8.0f, 1 / 1024.0f, 15 * vertex + k - 1));
  }
}

TEST(Checkpoint, OfTriangleSplattingPlusByTorchIsRead) {
  const Scene scene = read_checkpoint(checkpoints / "triangle_splatting_plus.pt");
  EXPECT_EQ(scene.info.source, "Triangle Splatting+ checkpoint");
  expect_connected(scene, 0.9999, 3);
}

TEST(Checkpoint, OfMeshSplattingByTorchIsRead) {
  const Scene scene = read_checkpoint(checkpoints / "mesh_splatting.pt");
  EXPECT_EQ(scene.info.source, "MeshSplatting checkpoint");
  expect_connected(scene, 0.999, 2);
}

TEST(Checkpoint, SurvivesTruncationAndDamage) {
  const auto read_sound = [](std::span<const std::byte> bytes) {
    const Scene scene = read_checkpoint(Input::memory("scene.pt", bytes));
    std::visit([](const auto& primitives) { EXPECT_EQ(defect(primitives), std::nullopt); },
               only_layer(scene).primitives);
  };
  for (const std::string& bytes :
       {DiffSoup{0}.file().bytes(), triangle_splatting(1, 3).bytes(), Connected().file().bytes()}) {
    EXPECT_EQ(test::survive_truncation(as_bytes(bytes), read_sound).read, 0u);
    EXPECT_GT(test::survive_damage(as_bytes(bytes), read_sound).refused, 1000u);
  }
}

}  // namespace checkpoint_test
}  // namespace tureen
