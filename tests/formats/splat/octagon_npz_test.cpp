#include "formats/splat/octagon_npz.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/matrix.hpp>

#include "formats/common/format_remarks.hpp"
#include "formats/scene_file.hpp"
#include "formats/splat/splat_remarks.hpp"
#include "tests/formats/format_testing.hpp"
#include "tests/formats/splat/octagon_fixture.hpp"
#include "tests/formats/splat/splat_fixture.hpp"
#include "tests/formats/truncation.hpp"

namespace tureen {
namespace octagon_npz_test {

using namespace test;
using ::testing::Contains;
using ::testing::ElementsAre;

const glm::dvec4 grey(0.5, 0.5, 0.5, 1);

Scene read(const std::string& bytes, ReadOptions options = {}) {
  return read_octagon_npz(Input::memory("a.npz", as_bytes(bytes)), options);
}

std::optional<Refusal> refusal(const ZipFixture& zip) {
  const std::string bytes = zip.bytes();
  return error_of([&] { read(bytes); });
}

/// sum over the axes of the disc of s^2 r r^T. It determines the disc.
glm::dmat3 spread(const glm::dvec3& x, const glm::dvec3& y) {
  return glm::outerProduct(x, x) + glm::outerProduct(y, y);
}
glm::dmat3 spread(const Gaussians& g, std::size_t i) {
  const glm::dmat3 axes(glm::mat3_cast(g.rotations[i]));
  return spread(axes[0] * double(g.scales[i].x), axes[1] * double(g.scales[i].y));
}

double largest(const glm::dmat3& m) {
  double value = 0;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) value = std::max(value, std::abs(m[c][r]));
  return value;
}

TEST(OctagonNpz, HasKnownValues) {
  const Scene scene = read(two_octagons().bytes());
  const Gaussians& g = only_gaussians(scene);
  EXPECT_TRUE(g.flat);
  ASSERT_EQ(g.centers.size(), 2u);
  const std::size_t i = g.centers[0].x > 0 ? 0 : 1;
  EXPECT_EQ(g.centers[i], glm::vec3(1, 2, 3));
  EXPECT_LT(glm::length(g.scales[i] - glm::vec3(0.5, 0.25, 0)), 1e-6f);
  EXPECT_NEAR(std::abs(g.rotations[i].w), 1, 1e-6);
  EXPECT_EQ(g.opacity[i], 0.75f);
  EXPECT_LT(glm::length(only_splats(scene).color.coefficients[i] -
                        glm::vec3(0.5, -0.5, 0) / float(harmonics::y00)),
            1e-6f);
  EXPECT_EQ(g.opacity[1 - i], 1.0f);
  EXPECT_EQ(only_splats(scene).profile, *profile_named("redisplats"));
  EXPECT_EQ(only_splats(scene).color.degree, 0);
  EXPECT_EQ(scene.info.name, "a");
  EXPECT_THAT(scene.info.remarks, Contains(Remark{&remarks::octagon_q_assumed, {{"q", 4.0}}}));
}

TEST(OctagonNpz, OfRandomDiscsGivesThemBack) {
  const unsigned seed = 1;
  Random random(seed);
  for (const double q : {4.0, 11.3449}) {
    for (int i = 0; i < 200; ++i) {
      const glm::dmat3 axes(glm::mat3_cast(random_rotation(random)));
      const glm::dvec3 center(random_vector(random));
      const glm::dvec3 x = axes[0] * std::exp(random.uniform(-6, 0)),
                       y = axes[1] * std::exp(random.uniform(-6, 0));
      ReadOptions options;
      options.octagon_q = q;
      const Scene scene = read(OctagonFixture().add(center, x, y, grey, q).bytes(), options);
      const Gaussians& g = only_gaussians(scene);
      ASSERT_EQ(g.centers.size(), 1u) << "seed " << seed << ", disc " << i;
      EXPECT_LT(glm::length(glm::dvec3(g.centers[0]) - center), 1e-6);
      // Floats have a relative error of 6e-8; scales count twice and rotations six times.
      const glm::dmat3 expected = spread(x, y);
      EXPECT_LT(largest(spread(g, 0) - expected), 1e-6 * largest(expected));
      const double longer = std::max(glm::length(x), glm::length(y)),
                   shorter = std::min(glm::length(x), glm::length(y));
      EXPECT_NEAR(g.scales[0].x / longer, 1, 1e-6);
      EXPECT_NEAR(g.scales[0].y / shorter, 1, 1e-6);
      EXPECT_EQ(g.scales[0].z, 0.0f);
      // The side of the disc from which the corners turn left.
      const glm::dvec3 normal(glm::mat3_cast(g.rotations[0])[2]);
      EXPECT_NEAR(glm::dot(normal, glm::normalize(glm::cross(x, y))), 1, 1e-6);
      EXPECT_THAT(scene.info.remarks, ElementsAre(Remark{&remarks::up_unknown_to_splats,
                                                         {{"format", "octagon mesh"}}}));
    }
  }
}

TEST(OctagonNpz, OfASimilarityOrAnAffineEditGivesTheImageOfTheDisc) {
  const unsigned seed = 2;
  Random random(seed);
  for (int i = 0; i < 200; ++i) {
    const glm::dmat3 shear(random_vector(random), random_vector(random), random_vector(random));
    const glm::dvec3 x = shear * glm::dvec3(0.5, 0, 0), y = shear * glm::dvec3(0, 0.2, 0);
    const Scene scene = read(OctagonFixture().add({1, 2, 3}, x, y, grey).bytes());
    const glm::dmat3 expected = spread(x, y);
    EXPECT_LT(largest(spread(only_gaussians(scene), 0) - expected), 1e-6 * largest(expected))
        << "seed " << seed << ", edit " << i;
  }
}

TEST(OctagonNpz, OfNumPyHasItsValues) {
  // By numpy 1.24.2 and the formula of generate_mesh.py, with Q = 4; numpy printed these values.
  const Scene scene = read_scene(TUREEN_SOURCE_DIR "/tests/formats/data/octagons.npz");
  const Gaussians& g = only_gaussians(scene);
  ASSERT_EQ(g.centers.size(), 3u);
  const auto check = [&](const glm::vec3& center, const glm::vec2& scales, const glm::vec3& normal,
                         const glm::vec4& color) {
    const auto at = std::min_element(g.centers.begin(), g.centers.end(), [&](auto& a, auto& b) {
      return glm::distance(a, center) < glm::distance(b, center);
    });
    const auto i = std::size_t(at - g.centers.begin());
    EXPECT_LT(glm::distance(g.centers[i], center), 1e-6f);
    EXPECT_NEAR(g.scales[i].x, std::max(scales.x, scales.y), 1e-6);
    EXPECT_NEAR(g.scales[i].y, std::min(scales.x, scales.y), 1e-6);
    EXPECT_NEAR(glm::dot(glm::mat3_cast(g.rotations[i])[2], normal), 1, 1e-6);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(only_splats(scene).color.coefficients[i][c],
                  (double(color[c]) - 0.5) / harmonics::y00, 1e-6);
    EXPECT_NEAR(g.opacity[i], color.a, 1e-7);
  };
  check({0.02364325f, 0.9009274f, -0.7116808f}, {0.4773713f, 0.2501811f},
        {-0.2757966f, -0.0972113f, -0.9562877f},
        {0.5108889f, 0.7530302f, 0.14792204f, 0.81962675f});
  check({0.8972989f, -0.3763371f, -0.1533471f}, {0.5300871f, 0.1236358f},
        {-0.1420269f, 0.7124513f, 0.6871983f}, {0.6832869f, 0.7870969f, 0.19161625f, 0.8023642f});
  check({0.6554052f, -0.1816017f, 0.0991874f}, {0.0744316f, 0.1668498f},
        {-0.9691733f, 0.2055491f, -0.1358404f}, {0.19132392f, 0.08155262f, 0.855227f, 0.8612835f});
}

TEST(OctagonNpz, ReadsOtherTypesAndOrders) {
  const OctagonFixture mesh = two_octagons();
  const std::string expected_bytes = mesh.bytes();
  const Scene expected = read(expected_bytes);
  const auto expect_same = [&](const ZipFixture& zip) {
    const std::string bytes = zip.bytes();
    const Scene scene = read(bytes);
    const Gaussians &g = only_gaussians(scene), &e = only_gaussians(expected);
    ASSERT_EQ(g.centers.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_LT(glm::distance(g.centers[i], e.centers[i]), 1e-6f);
      EXPECT_LT(largest(spread(g, i) - spread(e, i)), 1e-6);
      EXPECT_NEAR(g.opacity[i], e.opacity[i], 1e-7);
    }
  };
  const auto with = [&](std::size_t entry, const std::string& content) {
    ZipFixture zip = mesh.zip();
    zip.entries[entry].content = content;
    return zip;
  };
  expect_same(with(0, npy(npy_header("<f4", 16, 3), raw_values<float>(mesh.vertices), 2)));
  expect_same(with(2, npy(npy_header("<f8", 16, 4), raw_values<double>(mesh.colors), 3)));
  expect_same(with(1, npy(npy_header("|u1", 12, 3), raw_values<std::uint8_t>(mesh.faces))));
  expect_same(with(1, npy(npy_header("|i1", 12, 3), raw_values<std::int8_t>(mesh.faces))));
  expect_same(with(1, npy(npy_header("<u2", 12, 3), raw_values<std::uint16_t>(mesh.faces))));
  expect_same(with(1, npy(npy_header("<i4", 12, 3), raw_values<std::int32_t>(mesh.faces))));
  std::vector<double> columns;
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t r = 0; r < 16; ++r) columns.push_back(mesh.vertices[3 * r + c]);
  expect_same(with(0, npy("{ 'shape':(16,3) ,'fortran_order': True, 'descr': '<f8'}   \n",
                          raw_values<double>(columns))));
  ZipFixture deflated = mesh.zip();
  for (auto& entry : deflated.entries) entry.deflate = true;
  expect_same(deflated);
}

TEST(OctagonNpz, DropsOctagonsWithoutAnArea) {
  const double nan = std::nan("");
  OctagonFixture mesh = two_octagons();
  mesh.add({0, 0, 0}, {0, 0, 0}, {0, 1, 0}, grey)
      .add({0, 0, 0}, {1, 1, 0}, {2, 2, 0}, grey)
      .add({0, 0, 0}, {0, 0, 0}, {0, 0, 0}, grey)
      .add({nan, 0, 0}, {1, 0, 0}, {0, 1, 0}, grey)
      .add({0, 0, 0}, {1e300, 0, 0}, {0, 1e300, 0}, grey)
      .add({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.5, nan, 0.5, 1})
      .add({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.5, 0.5, 0.5, 1.5})
      // Thin, and drawn.
      .add({0, 0, 0}, {1, 0, 0}, {0, 1e-9, 0}, grey);
  const Scene scene = read(mesh.bytes());
  EXPECT_EQ(only_gaussians(scene).centers.size(), 3u);
  EXPECT_THAT(scene.info.remarks,
              Contains(Remark{&remarks::splats_dropped, {{"dropped", 7}, {"all", 10}}}));
  EXPECT_EQ(defect(only_splats(scene)), std::nullopt);
}

TEST(OctagonNpz, IsRecognisedByItsContent) {
  const TemporaryFolder folder;
  std::ofstream(folder / "a.bin", std::ios::binary) << two_octagons().bytes();
  EXPECT_EQ(count(only_splats(read_scene(folder / "a.bin"))), 2u);
  EXPECT_FALSE(is_octagon_npz(as_bytes(TorchFixture().bytes())));
  EXPECT_FALSE(is_octagon_npz(as_bytes(two_octagons().bytes()).first(40)));
  EXPECT_FALSE(is_octagon_npz({}));
}

TEST(OctagonNpz, RejectsMeshes) {
  const auto changed = [](auto&& change) {
    OctagonFixture mesh = two_octagons();
    change(mesh);
    return refusal(mesh.zip());
  };
  for (std::size_t entry = 0; entry < 3; ++entry) {
    ZipFixture zip = two_octagons().zip();
    const std::string name = zip.entries[entry].name;
    zip.entries[entry].name = "other.npy";
    EXPECT_THAT(refusal(zip), ErrorIn("a.npz", name));
  }
  EXPECT_THAT(changed([](auto& m) { m.vertices.resize(3 * 15); }),
              ErrorIn("a.npz", "vertices", 15, 8));
  EXPECT_THAT(changed([](auto& m) { m.faces.resize(3 * 11); }), ErrorIn("a.npz", "faces", 11, 12));
  EXPECT_THAT(changed([](auto& m) { m.colors.resize(4 * 8); }),
              ErrorIn("a.npz", "vertex_colors", 8, 16));
  EXPECT_THAT(changed([](auto& m) { std::swap(m.faces[3 * 7], m.faces[3 * 7 + 1]); }),
              ErrorIn("a.npz", "faces", 7));
  EXPECT_THAT(changed([](auto& m) { m.faces[0] = -1; }), ErrorIn("a.npz", "faces", 0));
  EXPECT_THAT(changed([](auto& m) { m.colors[4 * 12 + 3] = 0.5; }),
              ErrorIn("a.npz", "vertex_colors", "octagon 1", 8, 12));
  const OctagonFixture mesh = two_octagons();
  ZipFixture zip = mesh.zip();
  zip.entries[1].content = npy(npy_header("<f8", 12, 3), raw_values<double>(mesh.faces));
  EXPECT_THAT(refusal(zip), ErrorIn("a.npz", "faces", "floats"));
  zip = mesh.zip();
  zip.entries[2].content = npy(npy_header("|u1", 16, 4), std::string(64, '\xff'));
  EXPECT_THAT(refusal(zip), ErrorIn("a.npz", "vertex_colors", "integers"));
  const std::string none = OctagonFixture().bytes();
  EXPECT_EQ(count(only_splats(read(none))), 0u);
}

TEST(OctagonNpz, RejectsArrays) {
  const OctagonFixture mesh = two_octagons();
  const std::string data = raw_values<double>(mesh.vertices);
  const auto vertices = [&](const std::string& content) {
    ZipFixture zip = mesh.zip();
    zip.entries[0].content = content;
    return refusal(zip);
  };
  const std::string header = npy_header("<f8", 16, 3);
  EXPECT_EQ(vertices(npy(header, data)), std::nullopt);
  EXPECT_THAT(vertices(""), ErrorIn("a.npz", "vertices", ".npy"));
  EXPECT_THAT(vertices("\x93NUMPX" + data), ErrorIn("a.npz", "vertices", ".npy"));
  EXPECT_THAT(vertices(npy(header, data, 4)), ErrorIn("a.npz", "vertices", 4));
  EXPECT_THAT(vertices(npy(header, data, 0)), ErrorIn("a.npz", "vertices", 0));
  EXPECT_THAT(vertices(npy(header, data).substr(0, 9)), ErrorIn("a.npz", "header"));
  EXPECT_THAT(vertices(npy(header, data).substr(0, 30)), ErrorIn("a.npz", "header"));
  EXPECT_THAT(vertices(npy(std::string(70000, ' ') + header, data, 2)), ErrorIn("a.npz", "header"));
  EXPECT_THAT(vertices(npy(header, data + "x")), ErrorIn("a.npz", 385, 16, 3));
  for (const char* type :
       {">f8", "<f2", "<c8", "<M8[s]", "|O", "|b1", "|f8", "<u1", "f8", "", "<f9"})
    EXPECT_THAT(vertices(npy(npy_header(type, 16, 3), data)),
                ErrorIn("a.npz", "vertices", std::string("'") + type + "'"));
  for (const char* shape : {"()", "(2, 8, 3)"})
    EXPECT_THAT(
        vertices(npy(
            "{'descr': '<f8', 'fortran_order': False, 'shape': " + std::string(shape) + "}", data)),
        ErrorIn("a.npz", "dimensions"));
  for (const char* shape : {"(48,)", "(4294967296, 4294967296)", "(16, 4)", "(0, 3)"})
    EXPECT_THAT(
        vertices(npy(
            "{'descr': '<f8', 'fortran_order': False, 'shape': " + std::string(shape) + "}", data)),
        ErrorIn("a.npz", "vertices"));
  for (const char* wrong :
       {"", "{", "{}", "{'descr': '<f8', 'fortran_order': False}",
        "{'descr': '<f8', 'descr': '<f8', 'fortran_order': False, 'shape': (16, 3)}",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (16, 3), 'more': 1}",
        "{'descr': '<f8', 'fortran_order': None, 'shape': (16, 3)}",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (16, -3)}",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (16 3)}",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (99999999999999999999, 3)}",
        "{'descr': [('x', '<f8')], 'fortran_order': False, 'shape': (16, 3)}",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (16, 3)} x",
        "{'descr': '<f8' 'fortran_order': False, 'shape': (16, 3)}", "{'descr: "})
    EXPECT_THAT(vertices(npy(wrong, data)), ErrorIn("a.npz", "vertices", "header")) << wrong;
}

TEST(OctagonNpz, StaysWithinTheBudget) {
  OctagonFixture mesh;
  for (int i = 0; i < 1000; ++i) mesh.add({i, 0, 0}, {1, 0, 0}, {0, 1, 0}, grey);
  ZipFixture zip = mesh.zip();
  for (auto& entry : zip.entries) entry.deflate = true;
  const std::string bytes = zip.bytes();
  const auto within = [&](std::uint64_t limit) {
    return error_of(
        [&] { read_octagon_npz(Input::memory("a.npz", as_bytes(bytes), MemoryBudget(limit))); });
  };
  // An octagon has 192 + 144 + 128 bytes in the arrays, and the scene less than as many.
  EXPECT_EQ(within(900000), std::nullopt);
  EXPECT_THAT(within(300000), ErrorIn("a.npz", "--max-memory"));
}

TEST(OctagonNpz, SurvivesTruncationAndDamage) {
  ZipFixture zip = two_octagons().zip();
  zip.entries[2].deflate = true;
  const std::string text = zip.bytes();
  const auto check = [](std::span<const std::byte> bytes) {
    const Scene scene = read_octagon_npz(Input::memory("a.npz", bytes));
    EXPECT_EQ(defect(only_splats(scene)), std::nullopt);
  };
  EXPECT_EQ(survive_truncation(as_bytes(text), check).read, 0u);
  EXPECT_GT(survive_damage(as_bytes(text), check).refused, 0u);
}

}  // namespace octagon_npz_test
}  // namespace tureen
