#include "formats/splat/compressed_ply.hpp"

#include <algorithm>
#include <cmath>

#include "formats/ply_file.hpp"
#include "formats/splat/splat_remarks.hpp"
#include "tests/formats/format_testing.hpp"
#include "tests/formats/splat/splat_fixture.hpp"
#include "tests/formats/truncation.hpp"

namespace tureen {
namespace compressed_ply_test {

using namespace test;
using ::testing::Each;
using Row = std::vector<double>;

PlyFixture::Columns chunk_columns(bool colors) {
  PlyFixture::Columns columns;
  for (const char* name :
       {"min_x", "min_y", "min_z", "max_x", "max_y", "max_z", "min_scale_x", "min_scale_y",
        "min_scale_z", "max_scale_x", "max_scale_y", "max_scale_z"})
    columns.push_back(std::string("float ") + name);
  for (const char* name : {"min_r", "min_g", "min_b", "max_r", "max_g", "max_b"})
    if (colors) columns.push_back(std::string("float ") + name);
  return columns;
}

const PlyFixture::Columns packed_columns{"uint packed_position", "uint packed_rotation",
                                         "uint packed_scale", "uint packed_color"};

Row chunk_row(bool colors, double x = 0) {
  Row row{x, 10, 20, x + 1, 12, 24, -4, -3, -2, 0, 0, 0};
  for (const double value : {-1.0, 0.0, 0.5, 1.0, 1.0, 0.5})
    if (colors) row.push_back(value);
  return row;
}

/// Fractions of the ranges: position (1, 0, 1), scale (0, 1, 0), colour (255, 0, 51) / 255 and
/// opacity 51 / 255. Rotation: the largest part is `largest`, the others are 1023, 0, 1023.
Row packed_row(std::uint32_t largest) {
  return {double(2047u << 21 | 2047u), double(largest << 30 | 1023u << 20 | 1023u),
          double(1023u << 11), double(255u << 24 | 51u << 8 | 51u)};
}

Scene read_packed_text(const std::string& text) {
  Input input = input_of(text, "a.compressed.ply");
  return read_ply(input);
}

TEST(CompressedPly, ReadsKnownValues) {
  for (const bool colors : {true, false}) {
    const Scene scene =
        read_packed_text(PlyFixture()
                             .comment("antialiased 1")
                             .element("chunk", chunk_columns(colors), {chunk_row(colors)})
                             .element("vertex", packed_columns, {packed_row(1)})
                             .text());
    const Gaussians& g = only_gaussians(scene);
    EXPECT_EQ(g.centers[0], glm::vec3(1, 10, 24));
    EXPECT_EQ(g.scales[0], glm::vec3(std::exp(-4.0), 1, std::exp(-2.0)));
    EXPECT_EQ(g.opacity[0], 51.0f / 255.0f);
    const glm::vec3 rgb = colors ? glm::vec3(1, 0, 0.5f) : glm::vec3(1, 0, 0.2f);
    EXPECT_LT(glm::length(only_splats(scene).color.coefficients[0] -
                          (rgb - 0.5f) / float(harmonics::y00)),
              1e-6f);
    EXPECT_EQ(only_splats(scene).profile, *profile_named("mip"));
    EXPECT_EQ(defect(only_splats(scene)), std::nullopt);
  }
}

TEST(CompressedPly, ReportsAnUnknownRenderMode) {
  const Scene scene =
      read_packed_text(PlyFixture()
                           .comment("SplatRenderMode: other")
                           .element("chunk", chunk_columns(false), {chunk_row(false)})
                           .element("vertex", packed_columns, {packed_row(1)})
                           .text());
  EXPECT_THAT(scene.info.remarks,
              ::testing::Contains(
                  Remark{&remarks::render_mode_unknown, {{"mode", "other"}, {"profile", "3dgs"}}}));
}

TEST(CompressedPly, UnpacksRotationsForEachLargestPart) {
  for (std::uint32_t largest = 0; largest < 4; ++largest) {
    // Two parts at 1 / 4 of their range, and the third in its middle.
    const double word = double(largest << 30 | 256u << 20 | 767u << 10 | 512u);
    const Scene scene =
        read_packed_text(PlyFixture()
                             .element("chunk", chunk_columns(false), {chunk_row(false)})
                             .element("vertex", packed_columns, {{0, word, 0, 0}})
                             .text());
    const glm::quat q = only_gaussians(scene).rotations[0];
    const float parts[] = {q.w, q.x, q.y, q.z};
    const double root = std::sqrt(2.0);
    std::vector<double> expected{(256 / 1023.0 - 0.5) * root, (767 / 1023.0 - 0.5) * root,
                                 (512 / 1023.0 - 0.5) * root};
    double rest = 1;
    for (const double value : expected) rest -= value * value;
    expected.insert(expected.begin() + largest, std::sqrt(rest));
    for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(parts[k], expected[k], 1e-6);
  }
}

TEST(CompressedPly, AChunkHolds256SplatsAndHarmonicsFollow) {
  std::vector<Row> packed(257, packed_row(0)), rest;
  for (int i = 0; i < 257; ++i) {
    Row row;
    for (int k = 0; k < 9; ++k) row.push_back(k == 0 ? 0 : k == 1 ? 255 : 16 * k);
    rest.push_back(row);
  }
  PlyFixture::Columns rest_columns;
  for (int k = 0; k < 9; ++k) rest_columns.push_back("uchar f_rest_" + std::to_string(k));
  const std::string text =
      PlyFixture()
          .element("chunk", chunk_columns(true), {chunk_row(true), chunk_row(true, 50)})
          .element("vertex", packed_columns, packed)
          .element("sh", rest_columns, rest)
          .text();
  const Scene scene = read_packed_text(text);
  const Gaussians& g = only_gaussians(scene);
  ASSERT_EQ(g.centers.size(), 257u);
  EXPECT_EQ(g.centers[255].x, 1.0f);
  EXPECT_EQ(g.centers[256].x, 51.0f);  // also the last in Morton order
  const SplatColor& color = only_splats(scene).color;
  ASSERT_EQ(color.degree, 1);
  const auto value = [](int k) {
    return float(k == 0 ? -4.0 : k == 1 ? 4.0 : ((16 * k + 0.5) / 256 - 0.5) * 8);
  };
  for (int c = 0; c < 3; ++c)
    for (int k = 0; k < 3; ++k)
      EXPECT_EQ(color.coefficients[std::size_t(4 + 1 + k)][c], value(3 * c + k));
}

TEST(CompressedPly, P2_RangesWithoutAnExtentHaveOneValue) {
  Row chunk = chunk_row(true);
  for (const std::size_t first : {0u, 6u, 12u})
    for (std::size_t k = 0; k < 3; ++k) chunk[first + 3 + k] = chunk[first + k];
  const Scene scene =
      read_packed_text(PlyFixture()
                           .element("chunk", chunk_columns(true), {chunk})
                           .element("vertex", packed_columns, {packed_row(0), packed_row(2)})
                           .text());
  const Gaussians& g = only_gaussians(scene);
  EXPECT_THAT(g.centers, Each(glm::vec3(0, 10, 20)));
  EXPECT_THAT(g.scales, Each(glm::vec3(std::exp(-4.0), std::exp(-3.0), std::exp(-2.0))));
  EXPECT_THAT(only_splats(scene).color.coefficients,
              Each(glm::vec3((glm::dvec3(-1, 0, 0.5) - 0.5) / harmonics::y00)));
}

TEST(CompressedPly, P2_SplatsOfChunksThatAreNotFiniteAreDropped) {
  for (const double value : {double(NAN), double(INFINITY), -double(INFINITY)})
    for (std::size_t at = 0; at < 18; ++at) {
      Row bad = chunk_row(true, 50);
      bad[at] = value;
      std::vector<Row> packed(257, packed_row(0));
      const Scene scene =
          read_packed_text(PlyFixture()
                               .element("chunk", chunk_columns(true), {chunk_row(true), bad})
                               .element("vertex", packed_columns, packed)
                               .text());
      EXPECT_EQ(defect(only_splats(scene)), std::nullopt);
      // Only this range has an end that is used alone, as the fraction is 1: a scale of
      // e^-infinity.
      EXPECT_EQ(only_gaussians(scene).centers.size(), at == 10 && value < 0 ? 257u : 256u) << at;
    }
}

TEST(CompressedPly, P2_NumbersAroundThatOfAChunk) {
  for (const std::size_t splats : {1u, 255u, 256u, 257u, 512u, 513u}) {
    const auto file = [&](std::size_t chunks) {
      std::vector<Row> ranges;
      for (std::size_t i = 0; i < chunks; ++i) ranges.push_back(chunk_row(false, 10.0 * double(i)));
      return PlyFixture()
          .element("chunk", chunk_columns(false), ranges)
          .element("vertex", packed_columns, std::vector<Row>(splats, packed_row(0)))
          .text();
    };
    const std::size_t chunks = (splats + 255) / 256;
    const Scene scene = read_packed_text(file(chunks));
    const Gaussians& g = only_gaussians(scene);
    ASSERT_EQ(g.centers.size(), splats);
    const float last = 10 * float(chunks - 1) + 1;
    const auto of_last = std::count(g.centers.begin(), g.centers.end(), glm::vec3(last, 10, 24));
    EXPECT_EQ(std::size_t(of_last), splats - 256 * (chunks - 1));
    for (const std::size_t wrong : {chunks - 1, chunks + 1})
      EXPECT_THAT(error_of([&] { read_packed_text(file(wrong)); }),
                  ErrorAt("a.compressed.ply:3", "chunk", wrong, splats));
  }
}

TEST(CompressedPly, RejectsByElement) {
  const auto refusal = [](const std::string& text) {
    return error_of([&] { read_packed_text(text); });
  };
  const auto chunks = [](std::size_t count) {
    return PlyFixture().element("chunk", chunk_columns(false),
                                std::vector<Row>(count, chunk_row(false)));
  };
  EXPECT_THAT(refusal(chunks(2).element("vertex", packed_columns, {packed_row(0)}).text()),
              ErrorAt("a.compressed.ply:3", "chunk", 2, 1));
  EXPECT_THAT(refusal(chunks(1)
                          .element("vertex", packed_columns, {packed_row(0)})
                          .element("sh", {"uchar f_rest_0"}, {})
                          .text()),
              ErrorIn("a.compressed.ply", "sh", 0, 1));
  EXPECT_THAT(refusal(chunks(1)
                          .element("vertex", packed_columns, {packed_row(0)})
                          .element("sh", {"uchar f_rest_0"}, {{0}})
                          .text()),
              ErrorIn("a.compressed.ply", "sh", 1));
  PlyFixture::Columns wrong = packed_columns;
  wrong[0] = "float packed_position";
  EXPECT_THAT(refusal(chunks(1).element("vertex", wrong, {packed_row(0)}).text()),
              ErrorIn("a.compressed.ply", "vertex", "packed_position"));
  wrong = packed_columns;
  wrong[1] = "uint other";
  EXPECT_THAT(refusal(chunks(1).element("vertex", wrong, {packed_row(0)}).text()),
              ErrorIn("a.compressed.ply", "vertex", "packed_rotation"));
}

TEST(CompressedPly, SurvivesTruncationAndDamage) {
  const std::string text = PlyFixture()
                               .element("chunk", chunk_columns(true), {chunk_row(true)})
                               .element("vertex", packed_columns, {packed_row(0), packed_row(3)})
                               .text();
  const auto read = [](std::span<const std::byte> bytes) {
    Input input = Input::memory("a.ply", bytes);
    const Scene scene = read_ply(input);
    const auto* splats = std::get_if<Splats>(&only_layer(scene).primitives);
    EXPECT_EQ(splats ? defect(*splats) : std::nullopt, std::nullopt);
  };
  const auto bytes = std::as_bytes(std::span(text));
  EXPECT_EQ(survive_truncation(bytes, read).read, 0u);
  EXPECT_GT(survive_damage(bytes, read).read, 0u);
}

}  // namespace compressed_ply_test
}  // namespace tureen
