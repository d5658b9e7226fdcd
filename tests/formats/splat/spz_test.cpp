// SPZ. The fixtures data/splat_transform_*.spz hold the splats of splat_transform.ply, converted by
// @playcanvas/splat-transform 2.7.1, which uses Niantic's code:
//   npx splat-transform splat_transform.ply --spz-version 3 splat_transform_3.spz
//   npx splat-transform splat_transform.ply splat_transform_4.spz
#include "formats/splat/spz.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/gtc/matrix_transform.hpp>

#include "formats/common/format_remarks.hpp"
#include "formats/scene_file.hpp"
#include "formats/splat/splat_remarks.hpp"
#include "tests/formats/format_testing.hpp"
#include "tests/formats/splat/splat_fixture.hpp"
#include "tests/formats/splat/spz_fixture.hpp"
#include "tests/formats/truncation.hpp"

namespace tureen {
namespace spz_test {

using namespace test;
using ::testing::Contains;
using ::testing::ElementsAre;

/// Half a turn about x: from the axes of SPZ to those of the scene.
const glm::dmat3 turn(1, 0, 0, 0, -1, 0, 0, 0, -1);

Scene read(const std::string& bytes, MemoryBudget budget = MemoryBudget()) {
  Input input = Input::memory("a.spz", as_bytes(bytes), std::move(budget));
  return read_spz(input);
}

std::optional<Refusal> refusal(const std::string& bytes) {
  return error_of([&] { read(bytes); });
}

/// The quaternion of spz_splat as (w, x, y, z), on the axes of SPZ.
glm::dquat stored_rotation(unsigned version) {
  if (version < 3) {
    const double x = 191 / 127.5 - 1, y = 64 / 127.5 - 1, z = 128 / 127.5 - 1;
    return {std::sqrt(1 - x * x - y * y - z * z), x, y, z};
  }
  const double unit = std::sqrt(0.5) / 511;
  const double x = 300 * unit, z = -100 * unit, w = 511 * unit;
  return {w, x, std::sqrt(1 - x * x - z * z - w * w), z};
}

class Spz : public ::testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(Version, Spz, ::testing::Values(1u, 2u, 3u, 4u));

TEST_P(Spz, HasKnownValues) {
  SpzFixture spz = spz_splat(GetParam(), 0);
  const Scene scene = read(spz.bytes());
  const Gaussians& g = only_gaussians(scene);
  EXPECT_FALSE(g.flat);
  EXPECT_THAT(g.centers, ElementsAre(glm::vec3(1.5f, 2.25f, -0.5f)));
  EXPECT_THAT(g.scales,
              ElementsAre(glm::vec3(1.0f, float(std::exp(-1.0)), float(std::exp(-10.0)))));
  EXPECT_THAT(g.opacity, ElementsAre(51 / 255.0f));
  EXPECT_LT(glm::length(only_splats(scene).color.coefficients[0] -
                        glm::vec3(-0.5 / 0.15, 0.5 / 0.15, -0.3 / 0.15)),
            1e-6f);
  // The axes of the ellipsoid, up to their signs; 1e-6: rounding to float.
  const glm::dmat3 axes = turn * glm::mat3_cast(stored_rotation(GetParam())),
                   found(glm::mat3_cast(g.rotations[0]));
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(std::abs(glm::dot(axes[k], found[k])), 1, 1e-6);
  EXPECT_EQ(only_splats(scene).profile, *profile_named("3dgs"));
  EXPECT_EQ(scene.info.up, glm::vec3(0, -1, 0));
  EXPECT_THAT(scene.info.remarks,
              ElementsAre(Remark{&remarks::up_unknown_to_splats, {{"format", "SPZ"}}}));
  spz.flags = 1;
  EXPECT_EQ(only_splats(read(spz.bytes())).profile, *profile_named("mip"));
  spz.fractional_bits = 10;
  EXPECT_EQ(only_gaussians(read(spz.bytes())).centers[0].x, GetParam() == 1 ? 1.5f : 6.0f);
}

TEST_P(Spz, TurnsHarmonicsWithTheAxes) {
  for (unsigned degree = 1; degree <= 4; ++degree) {
    const SpzFixture spz = spz_splat(GetParam(), degree);
    const Scene scene = read(spz.bytes());
    const SplatColor& color = only_splats(scene).color;
    ASSERT_EQ(color.degree, int(degree));
    const auto stored = [&](std::size_t k, std::size_t c) {
      return (std::uint8_t(spz.arrays[5][3 * (k - 1) + c]) - 128) / 128.0;
    };
    const glm::dvec3 direction = glm::normalize(glm::dvec3(0.3, -0.7, 0.5));
    const auto before = harmonics::basis(turn * direction), after = harmonics::basis(direction);
    for (std::size_t k = 1; k < color.coefficients.size(); ++k)
      for (std::size_t c = 0; c < 3; ++c) {
        // Niantic's code stores the last one of degree 4 with the other sign.
        const double sign = k == 24 ? -1 : 1;
        EXPECT_NEAR(after[k] * double(color.coefficients[k][int(c)]),
                    sign * before[k] * stored(k, c), 1e-6)
            << k;
      }
  }
}

TEST(Spz, P1_ValuesAtTheEndsOfTheirRangesKeepTheirSigns) {
  SpzFixture spz = spz_splat(4, 1);
  spz.arrays[0].clear();
  for (const std::uint32_t fixed : {0x7fffffu, 0x800000u, 0xffffffu})
    append_little(spz.arrays[0], fixed, 3);
  spz.arrays[5] = std::string(3, '\x00') + std::string(3, '\xff') + std::string(3, '\x80');
  const Scene scene = read(spz.bytes());
  // With 12 bits behind the point, at most 2048 units.
  const double step = std::ldexp(1.0, -12);
  EXPECT_THAT(only_gaussians(scene).centers,
              ElementsAre(glm::vec3(glm::dvec3(2048 - step, 2048, step))));
  const std::vector<glm::vec3>& coefficients = only_splats(scene).color.coefficients;
  const float values[] = {-1, 127 / 128.0f, 0};
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_EQ(glm::abs(coefficients[k + 1]), glm::vec3(std::abs(values[k]))) << k;
  // The turn about x changes the signs of y and z, and not that of x.
  EXPECT_EQ(coefficients[1], glm::vec3(1));
  EXPECT_EQ(coefficients[2], glm::vec3(-values[1]));
  // Fewer bits behind the point reach farther.
  spz.fractional_bits = 0;
  EXPECT_EQ(only_gaussians(read(spz.bytes())).centers[0], glm::vec3(8388607, 8388608, 1));
}

TEST(Spz, HasEachLargestPartOfARotation) {
  for (std::uint32_t largest = 0; largest < 4; ++largest) {
    SpzFixture spz = spz_splat(3, 0);
    spz.arrays[4].clear();
    append_little(spz.arrays[4], largest << 30 | 100u << 20 | (512u | 200u) << 10 | 300u, 4);
    std::vector<double> parts{100, -200, 300};
    for (double& part : parts) part *= std::sqrt(0.5) / 511;
    double rest = 1;
    for (const double part : parts) rest -= part * part;
    parts.insert(parts.begin() + largest, std::sqrt(rest));
    const glm::quat q = only_gaussians(read(spz.bytes())).rotations[0];
    const glm::dquat expected(parts[3], parts[0], -parts[1], -parts[2]);
    EXPECT_NEAR(std::abs(glm::dot(glm::dquat(q), expected)), 1, 1e-6) << largest;
  }
}

TEST(Spz, BySplatTransformIsItsInputWithinTheQuantisation) {
  const std::filesystem::path data = TUREEN_SOURCE_DIR "/tests/formats/data";
  const Scene ply = read_scene(data / "splat_transform.ply");
  const Gaussians& in = only_gaussians(ply);
  for (const char* name : {"splat_transform_3.spz", "splat_transform_4.spz"}) {
    const Scene spz = read_scene(data / name);
    const Gaussians& out = only_gaussians(spz);
    const SplatColor &before = only_splats(ply).color, &after = only_splats(spz).color;
    ASSERT_EQ(out.centers.size(), in.centers.size());
    ASSERT_EQ(after.degree, 1);
    for (std::size_t i = 0; i < in.centers.size(); ++i) {
      const auto at = std::min_element(
          out.centers.begin(), out.centers.end(), [&](const glm::vec3& a, const glm::vec3& b) {
            return glm::distance(a, in.centers[i]) < glm::distance(b, in.centers[i]);
          });
      const auto j = std::size_t(at - out.centers.begin());
      for (int k = 0; k < 3; ++k) {
        // Half a step of 2^-12, and of 1/16 in the logarithm. 1e-6: rounding to float.
        EXPECT_NEAR(out.centers[j][k], in.centers[i][k], 0.5 / 4096 + 1e-6);
        EXPECT_NEAR(std::log(out.scales[j][k] / in.scales[i][k]), 0, 0.5 / 16 + 1e-6);
      }
      EXPECT_NEAR(out.opacity[j], in.opacity[i], 0.5 / 255 + 1e-6);
      // Three parts are wrong by at most half a step, sqrt(1/2) / 511 / 2 = 6.9e-4, and the largest
      // one, at least 1/2, by at most the sum of the others' errors. The chord is thus at most
      // sqrt(3 + 3^2) * 6.9e-4 = 2.4e-3, and the dot product at least 1 - chord^2 / 2.
      EXPECT_GE(std::abs(glm::dot(out.rotations[j], in.rotations[i])), 1 - 3e-6);
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(after.coefficients[4 * j][c], before.coefficients[4 * i][c],
                    0.5 / 255 / 0.15 + 1e-6);
        // 5 bits for -1..1: half a step of 1/16, and rounding to a byte before that.
        for (std::size_t k = 1; k < 4; ++k)
          EXPECT_NEAR(after.coefficients[4 * j + k][c],
                      std::clamp(before.coefficients[4 * i + k][c], -1.0f, 1.0f),
                      0.5 / 16 + 0.5 / 128 + 1e-6);
      }
    }
  }
}

TEST(Spz, IsRecognisedByItsContent) {
  const std::string plain = spz_splat(4, 0).bytes(), packed = spz_splat(2, 0).bytes();
  for (const std::string& bytes : {plain, packed}) {
    EXPECT_TRUE(is_spz(as_bytes(bytes)));
    EXPECT_FALSE(is_spz(as_bytes(bytes).first(3)));
  }
  EXPECT_FALSE(is_spz(as_bytes(gzipped("NGS"))));
  EXPECT_FALSE(is_spz(as_bytes(gzipped("a text"))));
  const TemporaryFolder folder;
  std::ofstream(folder / "a.bin", std::ios::binary) << packed;
  EXPECT_EQ(count(only_splats(read_scene(folder / "a.bin"))), 1u);
  std::ofstream(folder / "b.ply", std::ios::binary) << plain;
  EXPECT_THAT(
      read_scene(folder / "b.ply").info.remarks,
      Contains(Remark{&remarks::content_misnamed, {{"extension", ".ply"}, {"format", "SPZ"}}}));
  SpzFixture none = spz_splat(4, 0);
  none.splats = 0;
  none.arrays = {};
  std::ofstream(folder / "none.spz", std::ios::binary) << none.bytes();
  EXPECT_THAT(error_of([&] { read_scene(folder / "none.spz"); }), ErrorIn("none.spz"));
}

TEST(Spz, RejectsHeaders) {
  EXPECT_THAT(refusal("NOSPZ"), ErrorAt("a.spz@0"));
  EXPECT_THAT(refusal(std::string(32, 'x')), ErrorAt("a.spz@0", "NGSP"));
  EXPECT_THAT(refusal(gzipped(std::string(32, 'x'))), ErrorAt("a.spz@0", "NGSP"));
  SpzFixture plain = spz_splat(4, 0), packed = spz_splat(3, 0);
  plain.version = 5;
  EXPECT_THAT(refusal(plain.bytes()), ErrorAt("a.spz@4", 5));
  packed.version = 0;
  EXPECT_THAT(refusal(packed.bytes()), ErrorAt("a.spz@4", 0, "gzip"));
  EXPECT_THAT(refusal(gzipped(spz_splat(4, 0).bytes())), ErrorAt("a.spz@4", 4, "gzip"));
  plain = spz_splat(4, 0);
  plain.degree = 5;
  EXPECT_THAT(refusal(plain.bytes()), ErrorAt("a.spz@12", 5, 4));
  plain = spz_splat(4, 0);
  plain.splats = 1u << 31;
  EXPECT_THAT(refusal(plain.bytes()), ErrorAt("a.spz@8", plain.bytes().size(), 2147483648));
}

TEST(Spz, RejectsStreams) {
  const std::string good = spz_splat(4, 1).bytes();
  const auto patched = [&](std::size_t at, std::uint64_t value, int bytes) {
    std::string text = good, field;
    append_little(field, value, bytes);
    return text.replace(at, field.size(), field);
  };
  EXPECT_EQ(refusal(good), std::nullopt);
  EXPECT_THAT(refusal(patched(16, 31, 4)), ErrorAt("a.spz@16"));
  EXPECT_THAT(refusal(patched(16, good.size() + 1, 4)), ErrorAt("a.spz@16"));
  EXPECT_THAT(refusal(patched(15, 5, 1)), ErrorIn("a.spz"));
  EXPECT_THAT(refusal(patched(15, 255, 1)), ErrorIn("a.spz", 255 * 16));
  EXPECT_THAT(refusal(patched(32 + 8, 10, 8)), ErrorAt("a.spz@40", 10, 9));
  EXPECT_THAT(refusal(patched(32, std::uint64_t(1) << 63, 8)), ErrorIn("a.spz"));
  EXPECT_THAT(refusal(patched(32 + 6 * 16, 0, 4)), ErrorAt("a.spz@128", 0));
  SpzFixture spz = spz_splat(4, 1);
  spz.degree = 0;
  EXPECT_THAT(refusal(spz.bytes()), ErrorAt("a.spz@15", 6, 5));
  spz = spz_splat(4, 0);
  spz.degree = 1;
  EXPECT_THAT(refusal(spz.bytes()), ErrorAt("a.spz@15", 5));
}

TEST(Spz, RejectsDamagedGzip) {
  const std::string good = spz_splat(3, 1).bytes();
  std::string damaged = good;
  damaged[good.size() - 8] = char(damaged[good.size() - 8] ^ 1);  // the checksum
  EXPECT_THAT(refusal(damaged), ErrorIn("a.spz", "gzip"));
  SpzFixture spz = spz_splat(3, 1);
  spz.arrays[5].pop_back();
  EXPECT_THAT(refusal(spz.bytes()), ErrorIn("a.spz", "gzip"));
  spz = spz_splat(3, 1);
  spz.trailing = std::string(65536, '\0');
  EXPECT_THAT(read(spz.bytes()).info.remarks,
              Contains(Remark{&remarks::bytes_ignored, {{"bytes", 65536}}}));
  spz.trailing += '\0';
  EXPECT_THAT(refusal(spz.bytes()), ErrorIn("a.spz", 65536));
}

TEST_P(Spz, ReportsOrRejectsExtensions) {
  const auto number = [](std::uint64_t value) {
    std::string text;
    append_little(text, value, 4);
    return text;
  };
  const auto with = [&](std::uint32_t type, const std::string& content) {
    return spz_splat(GetParam(), 1).extension(type, content);
  };
  // A limit for cameras, and the axes that SPZ has.
  SpzFixture spz = with(0xADBE0002, std::string(12, 'x'));
  spz.extension(0xADBE0003, number(4)).extension(0x00010002, "").extension(0x00010002, "abc");
  EXPECT_THAT(
      read(spz.bytes()).info.remarks,
      Contains(Remark{&remarks::splat_extensions_ignored,
                      {{"extensions", std::vector<std::string>{"0x00010002", "0xADBE0002"}}}}));
  EXPECT_EQ(refusal(with(0xADBE0003, number(0)).bytes()), std::nullopt);
  EXPECT_THAT(refusal(with(0xADBE0003, number(6)).bytes()), ErrorIn("a.spz", "0xADBE0003", 6, 4));
  EXPECT_THAT(refusal(with(0xADBE0003, "").bytes()), ErrorIn("a.spz", "0xADBE0003", 4));
  EXPECT_THAT(refusal(with(0xADBE0001, "xy").bytes()), ErrorIn("a.spz", "0xADBE0001"));
  spz = with(0xADBE0002, "abcd");
  spz.extensions.pop_back();
  EXPECT_THAT(refusal(spz.bytes()), ErrorIn("a.spz", "extension"));
  spz.extensions.resize(7);
  EXPECT_THAT(refusal(spz.bytes()), ErrorIn("a.spz", "extension"));
}

TEST_P(Spz, ReportsTrailingBytes) {
  SpzFixture spz = spz_splat(GetParam(), 0);
  spz.trailing = "abc";
  EXPECT_THAT(read(spz.bytes()).info.remarks,
              Contains(Remark{&remarks::bytes_ignored, {{"bytes", 3}}}));
}

TEST_P(Spz, StaysWithinTheBudget) {
  SpzFixture spz = spz_splat(GetParam(), 4);
  for (std::string& array : spz.arrays) array = std::string(10000 * array.size(), '\0');
  spz.splats = 10000;
  const std::string bytes = spz.bytes();
  EXPECT_EQ(error_of([&] { read(bytes); }), std::nullopt);
  // 10,000 splats have 870 to 920 kB in the arrays.
  EXPECT_THAT(error_of([&] { read(bytes, MemoryBudget(800000)); }),
              ErrorIn("a.spz", "packed splats", "--max-memory"));
}

TEST_P(Spz, SurvivesTruncationAndDamage) {
  const std::string text = spz_splat(GetParam(), 1).extension(0xADBE0002, "abcd").bytes();
  const auto check = [](std::span<const std::byte> bytes) {
    Input input = Input::memory("a.spz", bytes);
    const Scene scene = read_spz(input);
    EXPECT_EQ(defect(only_splats(scene)), std::nullopt);
  };
  EXPECT_EQ(survive_truncation(as_bytes(text), check).read, 0u);
  EXPECT_GT(survive_damage(as_bytes(text), check).refused, 0u);
}

}  // namespace spz_test
}  // namespace tureen
