#include "formats/splat/splat_ply.hpp"

#include <cmath>
#include <fstream>
#include <glm/gtc/quaternion.hpp>

#include "formats/common/format_remarks.hpp"
#include "formats/ply_file.hpp"
#include "formats/scene_file.hpp"
#include "formats/splat/splat_remarks.hpp"
#include "tests/formats/format_testing.hpp"
#include "tests/formats/splat/splat_fixture.hpp"
#include "tests/formats/truncation.hpp"

namespace tureen {
namespace splat_ply_test {

using namespace test;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::Not;
using Row = std::vector<double>;

Scene read_text(const std::string& text) {
  Input input = input_of(text, "folder/guitar.ply");
  return read_ply(input);
}
std::optional<Refusal> refusal(const std::string& text) {
  return error_of([&] { read_text(text); });
}

/// x y z, normal, colour, rest, opacity, scales, rotation (w = 2).
Row splat_row(double x, int rest = 0, int scales = 3, double opacity = 0.25) {
  Row row{x, 2, 3, 9, 9, 9, 0.1, 0.2, 0.3};
  for (int k = 0; k < rest; ++k) row.push_back(k + 1);
  row.push_back(opacity);
  for (int k = 0; k < scales; ++k) row.push_back(-0.5 * k);
  for (const double part : {2.0, 0.0, 0.0, 0.0}) row.push_back(part);
  return row;
}

std::string gaussian_file(const std::vector<Row>& rows, int rest = 0, int scales = 3,
                          const char* comment = nullptr,
                          const char* encoding = "binary_little_endian") {
  PlyFixture file(encoding);
  if (comment) file.comment(comment);
  return file.element("vertex", splat_columns(rest, scales), rows).text();
}

const char* const splat_encodings[] = {"ascii", "binary_little_endian", "binary_big_endian"};

TEST(SplatPly, ReadsKnownValuesInEveryEncodingAndDegree) {
  for (const char* encoding : splat_encodings)
    for (int degree = 0; degree <= 4; ++degree) {
      const int count = harmonics::count(degree), rest = 3 * (count - 1);
      const Scene scene =
          read_text(gaussian_file({splat_row(1, rest)}, rest, 3, nullptr, encoding));
      const Gaussians& g = only_gaussians(scene);
      EXPECT_FALSE(g.flat);
      EXPECT_THAT(g.centers, ElementsAre(glm::vec3(1, 2, 3)));
      EXPECT_THAT(g.scales, ElementsAre(glm::vec3(1, std::exp(-0.5), std::exp(-1.0))));
      EXPECT_THAT(g.rotations, ElementsAre(glm::quat(1, 0, 0, 0)));
      EXPECT_THAT(g.opacity, ElementsAre(float(1 / (1 + std::exp(-0.25)))));
      const SplatColor& color = only_splats(scene).color;
      ASSERT_EQ(color.degree, degree);
      EXPECT_EQ(color.coefficients[0], glm::vec3(0.1f, 0.2f, 0.3f));
      // The file has all of red, then of green, then of blue.
      for (int i = 1; i < count; ++i)
        EXPECT_EQ(color.coefficients[std::size_t(i)],
                  glm::vec3(i, i + count - 1, i + 2 * (count - 1)));
      EXPECT_EQ(only_splats(scene).profile, *profile_named("3dgs"));
      EXPECT_EQ(scene.info.name, "guitar");
      EXPECT_EQ(scene.info.up, glm::vec3(0, -1, 0));
      EXPECT_TRUE(scene.info.up_is_assumed);
      EXPECT_THAT(scene.info.remarks,
                  ElementsAre(Remark{&remarks::up_unknown_to_splats, {{"format", "PLY"}}}));
      EXPECT_EQ(defect(only_splats(scene)), std::nullopt);
    }
}

TEST(SplatPly, FindsPropertiesByNameInAnyOrderAndType) {
  const std::string text =
      PlyFixture()
          .element("camera", {"float f"}, {{7}})
          .element(
              "vertex",
              {"double rot_3", "float rot_0", "uint extra", "float rot_2", "float rot_1",
               "float scale_2", "float scale_0", "float scale_1", "float opacity", "float f_dc_2",
               "float f_dc_1", "float f_dc_0", "double z", "float y", "float x"},
              {{4, 1, 99, 3, 2, 0.3, 0.1, 0.2, 0, 7, 6, 5, 3, 2, 1}})
          .text();
  const Scene scene = read_text(text + "tail");
  const Gaussians& g = only_gaussians(scene);
  EXPECT_THAT(g.centers, ElementsAre(glm::vec3(1, 2, 3)));
  EXPECT_LT(glm::length(g.rotations[0] - glm::normalize(glm::quat(1, 2, 3, 4))), 1e-6f);
  EXPECT_FLOAT_EQ(g.scales[0].z, std::exp(0.3f));
  EXPECT_EQ(only_splats(scene).color.coefficients[0], glm::vec3(5, 6, 7));
  EXPECT_THAT(scene.info.remarks, Contains(Remark{&remarks::bytes_ignored, {{"bytes", 4}}}));
  EXPECT_THAT(scene.info.remarks, Contains(Remark{&remarks::coordinates_rounded}));
}

TEST(SplatPly, X6_ScalesAndHarmonicsAreFoundByName) {
  for (const int scales : {2, 3}) {
    PlyFixture::Columns columns = splat_columns(9, scales);
    Row row = splat_row(1, 9, scales);
    const Scene expected = read_text(PlyFixture().element("vertex", columns, {row}).text());
    EXPECT_EQ(only_gaussians(expected).flat, scales == 2);
    std::reverse(columns.begin(), columns.end());
    std::reverse(row.begin(), row.end());
    // Columns in between, so that a reader by offset would find other ones.
    columns.insert(columns.begin() + 6, "float extra");
    row.insert(row.begin() + 6, 77);
    const Scene scene = read_text(PlyFixture().element("vertex", columns, {row}).text());
    EXPECT_EQ(only_splats(scene).color.coefficients, only_splats(expected).color.coefficients);
    EXPECT_EQ(only_gaussians(scene).scales, only_gaussians(expected).scales);
    EXPECT_EQ(only_gaussians(scene).rotations, only_gaussians(expected).rotations);
    EXPECT_EQ(only_gaussians(scene).flat, scales == 2);
  }
}

TEST(SplatPly, CommentsSelectTheProfileAndTheLastCounts) {
  const auto profile = [](int scales, std::initializer_list<const char*> comments) {
    PlyFixture file;
    for (const char* comment : comments) file.comment(comment);
    const Scene scene = read_text(
        file.element("vertex", splat_columns(0, scales), {splat_row(1, 0, scales)}).text());
    EXPECT_EQ(defect(only_splats(scene)), std::nullopt);
    return std::string(name_of(only_splats(scene).profile)) +
           (only_gaussians(scene).flat ? " flat" : "");
  };
  EXPECT_EQ(profile(3, {"SplatRenderMode: default"}), "3dgs");
  EXPECT_EQ(profile(3, {"SplatRenderMode:  mip"}), "mip");
  EXPECT_EQ(profile(3, {"antialiased 1"}), "mip");
  EXPECT_EQ(profile(3, {"antialiased 1", "SplatRenderMode: default"}), "3dgs");
  EXPECT_EQ(profile(3, {"SplatRenderMode: mip", "antialiased 0"}), "3dgs");
  EXPECT_EQ(profile(3, {"SplatRenderMode: mip", "SplatRenderMode: other"}), "mip");
  EXPECT_EQ(profile(3, {"SplatRenderMode: other"}), "3dgs");
  EXPECT_EQ(profile(2, {"SplatRenderMode: other"}), "2dgs flat");
  EXPECT_EQ(profile(3, {"SplatRenderMode: 2dgs"}), "2dgs flat");
  EXPECT_EQ(profile(2, {}), "2dgs flat");
  EXPECT_EQ(profile(2, {"SplatRenderMode: default"}), "3dgs flat");  // GaMeS has the same profile
  EXPECT_EQ(profile(2, {"SplatRenderMode: mip"}), "mip flat");
  EXPECT_EQ(profile(2, {"TureenSplatProfile: redisplats"}), "redisplats flat");
  EXPECT_EQ(profile(3, {"TureenSplatProfile: redisplats"}), "3dgs");
}

TEST(SplatPly, AnUnknownRenderModeIsRemarked) {
  const Scene scene = read_text(PlyFixture()
                                    .comment("SplatRenderMode: other")
                                    .element("vertex", splat_columns(0, 3), {splat_row(1, 0, 3)})
                                    .text());
  EXPECT_THAT(scene.info.remarks, Contains(Remark{&remarks::render_mode_unknown,
                                                  {{"mode", "other"}, {"profile", "3dgs"}}}));
}

TEST(SplatPly, TheProfileOfFlatGaussiansSelectsTheirAxes) {
  Row row = splat_row(1, 0, 2);
  const glm::quat stored = glm::normalize(glm::quat(1, 2, -3, 4));
  std::copy_n(std::initializer_list<double>{stored.w, stored.x, stored.y, stored.z}.begin(), 4,
              row.end() - 4);
  const Scene as_2dgs = read_text(gaussian_file({row}, 0, 2));
  EXPECT_THAT(as_2dgs.info.remarks,
              Contains(Remark{&remarks::profile_assumed, {{"profile", "2dgs"}}}));
  EXPECT_EQ(only_gaussians(as_2dgs).rotations[0], stored);
  EXPECT_EQ(only_gaussians(as_2dgs).scales[0].z, 0.0f);
  const Scene as_games = read_text(gaussian_file({row}, 0, 2, "SplatRenderMode: default"));
  EXPECT_EQ(as_games.info.remarks.size(), 1u);
  // GaMeS: the normal is the file's x axis; scale_0 and scale_1 belong to its y and z.
  const glm::mat3 file = glm::mat3_cast(stored);
  const glm::mat3 ours = glm::mat3_cast(only_gaussians(as_games).rotations[0]);
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_LT(glm::length(ours[axis] - file[(axis + 1) % 3]), 1e-6f);
  EXPECT_EQ(only_gaussians(as_games).scales[0], only_gaussians(as_2dgs).scales[0]);
}

TEST(SplatPly, InfiniteLogitsAreOpacities0And1) {
  for (const char* encoding : splat_encodings) {
    const Scene scene = read_text(gaussian_file(
        {splat_row(0, 0, 3, -INFINITY), splat_row(1, 0, 3, INFINITY)}, 0, 3, nullptr, encoding));
    EXPECT_THAT(only_gaussians(scene).opacity, ElementsAre(0.0f, 1.0f));
  }
}

TEST(SplatPly, DropsInvalidSplatsAndCountsThem) {
  const std::size_t last = splat_row(0, 9).size() - 1;
  const auto bad = [&](std::size_t at, double value) {
    Row row = splat_row(5, 9);
    row[at] = value;
    return row;
  };
  const std::vector<Row> rows{bad(0, NAN),        bad(2, INFINITY),   bad(6, NAN),
                              bad(17, -INFINITY), bad(last - 7, NAN), bad(last - 4, NAN),
                              bad(last - 4, 89),  // e^89 exceeds float
                              bad(last - 3, 0),   bad(last, NAN),     bad(last, INFINITY),
                              splat_row(1, 9),    bad(3, NAN)};  // normals are not used
  const Scene scene = read_text(gaussian_file(rows, 9));
  EXPECT_THAT(only_gaussians(scene).centers, ElementsAre(glm::vec3(1, 2, 3), glm::vec3(5, 2, 3)));
  EXPECT_THAT(scene.info.remarks,
              Contains(Remark{&remarks::splats_dropped, {{"dropped", 10}, {"all", rows.size()}}}));
  EXPECT_EQ(defect(only_splats(scene)), std::nullopt);
}

TEST(SplatPly, TinyScalesAndQuaternionsAreValid) {
  Row row = splat_row(1);
  row[10] = -1000;  // underflows to 0
  row[13] = 1e-30;  // w; its square underflows in single precision
  const Scene scene = read_text(gaussian_file({row}));
  EXPECT_EQ(only_gaussians(scene).scales[0].x, 0.0f);
  EXPECT_EQ(only_gaussians(scene).rotations[0], glm::quat(1, 0, 0, 0));
}

Row density_row(double scale) {
  Row row{1, 2, 3, 0, 0, 0, 0.1, 0.2, 0.3};
  for (int k = 0; k < 45; ++k) row.push_back(k + 1);
  for (const double value : {0.0, 0.0, 0.0, scale, 1.0, 1.0, 0.0, 0.0, 0.0}) row.push_back(value);
  for (int k = 0; k < 41; ++k) row.push_back(100 + k);
  return row;
}

TEST(SplatPly, ReadsNeuralDensities) {
  const auto file = [](const std::vector<Row>& rows) {
    return PlyFixture().element("vertex", density_columns(), rows).text();
  };
  ASSERT_EQ(density_columns().size(), 104u);
  const Scene scene = read_text(file({density_row(-1), density_row(-200)}));
  const auto& densities = std::get<NeuralDensities>(only_splats(scene).kernel);
  EXPECT_EQ(defect(only_splats(scene)), std::nullopt);
  EXPECT_THAT(densities.semi_axes, ElementsAre(glm::vec3(1, std::exp(-1.0), std::exp(1.0))));
  EXPECT_EQ(densities.omega, 30.0f);
  // frequencies_k has dimension k / 8 and neuron k % 8.
  for (int neuron = 0; neuron < 8; ++neuron)
    for (int dimension = 0; dimension < 3; ++dimension)
      EXPECT_EQ(densities.networks[std::size_t(3 * neuron + dimension)],
                float(100 + 8 * dimension + neuron));
  for (std::size_t k = 24; k < 41; ++k) EXPECT_EQ(densities.networks[k], float(100 + k));
  EXPECT_EQ(only_splats(scene).color.degree, 3);
  // The second one has a semi-axis of e^-200, which is 0 in single precision.
  EXPECT_THAT(scene.info.remarks,
              Contains(Remark{&remarks::splats_dropped, {{"dropped", 1}, {"all", 2}}}));
  EXPECT_EQ(only_splats(scene).profile, *profile_named("splatnet"));
}

TEST(SplatPly, RejectsByElementAndProperty) {
  const auto without = [](const std::string& name) {
    PlyFixture::Columns columns = splat_columns(9, 3);
    Row row = splat_row(1, 9);
    const auto at = std::find(columns.begin(), columns.end(), name) - columns.begin();
    columns.erase(columns.begin() + at);
    row.erase(row.begin() + at);
    return PlyFixture().element("vertex", columns, {row}).text();
  };
  for (const char* name : {"x", "f_dc_1", "opacity", "scale_1", "rot_3"})
    EXPECT_THAT(refusal(without(std::string("float ") + name)),
                ErrorAt("folder/guitar.ply:3", "vertex", name));
  EXPECT_THAT(refusal(without("float f_rest_4")), ErrorAt("folder/guitar.ply:3", "f_rest_..", 8));
  PlyFixture::Columns twice = splat_columns(0, 3);
  twice.push_back("float opacity");
  Row row = splat_row(1);
  row.push_back(0);
  EXPECT_THAT(refusal(PlyFixture().element("vertex", twice, {row}).text()),
              ErrorAt("folder/guitar.ply:3", "vertex", "opacity"));
  PlyFixture::Columns strange = splat_columns(9, 3);
  *std::find(strange.begin(), strange.end(), "float f_rest_8") = "float f_rest_9";
  EXPECT_THAT(refusal(PlyFixture().element("vertex", strange, {splat_row(1, 9)}).text()),
              ErrorAt("folder/guitar.ply:3", "f_rest_8"));
}

/// A file with these columns instead of f_dc, and a row for each centre.
std::string file_with(const PlyFixture::Columns& colors, const Row& values,
                      const std::vector<glm::dvec3>& centers, const std::string& real = "float",
                      const PlyFixture::Columns& more = {}, const Row& extra = {}) {
  PlyFixture::Columns columns{real + " x", real + " y", real + " z"};
  columns.insert(columns.end(), colors.begin(), colors.end());
  for (const char* name :
       {"opacity", "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"})
    columns.push_back(std::string("float ") + name);
  columns.insert(columns.end(), more.begin(), more.end());
  std::vector<Row> rows;
  for (const glm::dvec3& center : centers) {
    Row row{center.x, center.y, center.z};
    row.insert(row.end(), values.begin(), values.end());
    row.insert(row.end(), {0.25, -1, -2, -3, 1, 0, 0, 0});
    row.insert(row.end(), extra.begin(), extra.end());
    rows.push_back(row);
  }
  return PlyFixture("binary_little_endian").element("vertex", columns, rows).text();
}
const PlyFixture::Columns harmonic_columns{"float f_dc_0", "float f_dc_1", "float f_dc_2"};

TEST(SplatPly, ReadsPlainColours) {
  const Scene scene =
      read_text(file_with({"uchar red", "uchar green", "uchar blue"}, {0, 51, 255}, {{1, 2, 3}}));
  const glm::vec3 color = std::get<Splats>(only_layer(scene).primitives).color.coefficients.at(0);
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(0.5 + harmonics::y00 * color[c], (std::array{0.0, 0.2, 1.0})[std::size_t(c)], 1e-6);
}

TEST(SplatPly, AppliesTheFilterOfMipSplatting) {
  const Scene scene = read_text(
      file_with(harmonic_columns, {0, 0, 0}, {{1, 2, 3}}, "float", {"float filter_3D"}, {0.2}));
  const Gaussians& g = only_gaussians(scene);
  double ratio = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double s = std::exp(-1.0 - axis), wide = std::sqrt(s * s + 0.04);
    EXPECT_NEAR(g.scales.at(0)[axis], wide, 1e-6);
    ratio *= s / wide;
  }
  EXPECT_NEAR(g.opacity.at(0), ratio / (1 + std::exp(-0.25)), 1e-6);
  EXPECT_THAT(scene.info.remarks, Contains(Remark{&remarks::filter_applied}));
}

TEST(SplatPly, TakesTheUpAxisOfNerfstudio) {
  const auto up = [](const char* comment) {
    const Scene scene = read_text(gaussian_file({splat_row(1)}, 0, 3, comment));
    EXPECT_EQ(scene.info.up_is_assumed, std::string(comment).ends_with("w"));
    return scene.info.up;
  };
  EXPECT_EQ(up("Vertical Axis: z"), glm::vec3(0, 0, 1));
  EXPECT_EQ(up("Vertical Axis: -y"), glm::vec3(0, -1, 0));
  EXPECT_EQ(up("Vertical Axis: w"), glm::vec3(0, -1, 0));
}

TEST(SplatPly, KeepsTheDigitsOfMapCoordinates) {
  const glm::dvec3 far(512345.625, 5398765.5, 123.25);
  std::vector<glm::dvec3> centers;
  for (int i = 0; i < 5; ++i) centers.push_back(far + glm::dvec3(0.001 * i, 0.5 * i, -0.25 * i));
  const Scene scene = read_text(file_with(harmonic_columns, {0, 0, 0}, centers, "double"));
  const glm::dvec3 origin = origin_of(only_layer(scene));
  const Gaussians& g = only_gaussians(scene);
  for (const glm::dvec3& center : centers) {
    double nearest = 1;
    for (const glm::vec3& read : g.centers)
      nearest = std::min(nearest, glm::length(origin + glm::dvec3(read) - center));
    EXPECT_LT(nearest, 1e-7);
  }
  EXPECT_THAT(scene.info.remarks, Not(Contains(Remark{&remarks::coordinates_rounded})));
}

TEST(SplatPly, LowersTheNearLimitOfSmallScenes) {
  for (const double unit : {0.01, 1.0, 1000.0}) {
    std::vector<glm::dvec3> centers;
    for (int i = 0; i < 100; ++i)
      centers.push_back(unit * glm::dvec3(std::cos(i), std::sin(i), 0.01 * i));
    const Scene scene = read_text(file_with(harmonic_columns, {0, 0, 0}, centers));
    const float limit = std::get<Splats>(only_layer(scene).primitives).profile.min_center_depth;
    if (unit < 1) {
      EXPECT_GT(limit, 0.05 * unit);
      EXPECT_LT(limit, 0.5 * unit);
    } else {
      EXPECT_EQ(limit, 0.2f);
    }
  }
}

TEST(SplatPly, ReadsCrLfInTheFirstLineAlone) {
  std::string text = gaussian_file({splat_row(1)});
  text.insert(3, "\r");
  EXPECT_EQ(only_gaussians(read_text(text)).centers.at(0), glm::vec3(1, 2, 3));
}

TEST(SplatPly, AFileWithFacesHoldsTriangles) {
  const std::string text =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
      "z\nproperty float scale_0\nproperty float rot_0\nproperty float opacity\nelement face "
      "1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 1 1 1\n1 0 0 1 1 1\n0 1 0 1 1 "
      "1\n3 0 1 2\n";
  EXPECT_EQ(only_soup(read_text(text)).triangles.size(), 1u);
}

TEST(SplatPly, SurvivesTruncationAndDamage) {
  std::vector<std::string> files{
      gaussian_file({splat_row(1, 9), splat_row(-1, 9)}, 9, 3, "antialiased 1"),
      gaussian_file({splat_row(1, 0, 2), splat_row(-1, 0, 2)}, 0, 2, nullptr, "ascii"),
      PlyFixture("binary_big_endian")
          .element("vertex", density_columns(), {density_row(0)})
          .text()};
  for (const std::string& file : files) {
    const auto read = [](std::span<const std::byte> bytes) {
      Input input = Input::memory("a.ply", bytes);
      const Scene scene = read_ply(input);
      const auto& primitives = only_layer(scene).primitives;
      const auto* splats = std::get_if<Splats>(&primitives);
      EXPECT_EQ(splats ? defect(*splats) : std::nullopt, std::nullopt);
    };
    const auto bytes = std::as_bytes(std::span(file));
    const Survival cut = survive_truncation(bytes, read);
    // A last number in ascii may lose its end and the line break.
    EXPECT_LE(cut.read, 3u);
    EXPECT_GT(survive_damage(bytes, read).read, 0u);
  }
}

TEST(SplatPly, RealScenes) {
  const std::string folder = std::string(TUREEN_SOURCE_DIR) + "/../shared/data/gaussians/";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " does not exist";
  const Scene guitar = read_scene(folder + "guitar_3dgs_dc.ply");
  EXPECT_EQ(count(only_splats(guitar)), 90854u);
  EXPECT_EQ(only_splats(guitar).color.degree, 0);
  EXPECT_EQ(guitar.info.remarks.size(), 1u);
  const Scene trailing = read_scene(folder + "sh3_trailing_bytes.ply");
  EXPECT_EQ(count(only_splats(trailing)), 100u);
  EXPECT_EQ(only_splats(trailing).color.degree, 3);
  EXPECT_EQ(trailing.info.remarks.back().kind, &remarks::bytes_ignored);
}

TEST(SplatPly, ASceneWithoutValidSplatsIsRejected) {
  const TemporaryFolder folder;
  std::ofstream(folder / "a.ply", std::ios::binary) << gaussian_file({splat_row(NAN)});
  EXPECT_THAT(error_of([&] { read_scene(folder / "a.ply"); }),
              ErrorIn((folder / "a.ply").string(), 1));
  std::ofstream(folder / "b.ply", std::ios::binary) << gaussian_file({});
  EXPECT_THAT(error_of([&] { read_scene(folder / "b.ply"); }),
              ErrorIn((folder / "b.ply").string()));
}

}  // namespace splat_ply_test
}  // namespace tureen
