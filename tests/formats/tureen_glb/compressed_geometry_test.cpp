// Geometry of compressed files: the same triangles, with each corner off by at most half a step.
#include "formats/tureen_glb/compressed_geometry.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "base/error.hpp"
#include "tests/formats/random_scene.hpp"
#include "tests/formats/truncation.hpp"

namespace tureen {
namespace compressed_geometry_test {

using test::RandomScene;

CompressedGeometry random_geometry(unsigned seed, std::size_t faces, bool shared) {
  RandomScene random(seed);
  const TriangleSoup soup = random.geometry(faces, shared);
  return {soup.positions, soup.triangles};
}

class CompressedGeometryBits : public ::testing::TestWithParam<int> {};

TEST_P(CompressedGeometryBits, CornersStayWithinHalfAStep) {
  const int bits = GetParam();
  for (const bool shared : {false, true}) {
    const unsigned seed = 61 + unsigned(bits);
    SCOPED_TRACE(::testing::Message() << "seed " << seed << ", shared " << shared);
    const CompressedGeometry before = random_geometry(seed, 200, shared);
    const auto bytes = encode_compressed_geometry(before, bits);
    const CompressedGeometry after =
        decode_compressed_geometry(bytes, used_vertices(before.triangles), 200, "compressed");
    ASSERT_EQ(after.triangles.size(), 200u);
    // Random positions in a box of side at most 4, plus the rounding of floats below 2 in the box's
    // corner, the step and the result.
    const double half = 0.5 * 4.0 / double((1 << bits) - 1) + 3 * std::ldexp(1.0, -23);
    std::vector<std::uint32_t> became(before.positions.size(), 0xffffffffu);
    for (std::size_t t = 0; t < 200; ++t)
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t b = before.triangles[t][k], a = after.triangles[t][k];
        for (int axis = 0; axis < 3; ++axis)
          ASSERT_NEAR(before.positions[b][axis], after.positions[a][axis], half) << t;
        // Corners with a common vertex keep a common vertex.
        if (became[b] == 0xffffffffu) became[b] = a;
        ASSERT_EQ(became[b], a) << "face " << t;
      }
  }
}

INSTANTIATE_TEST_SUITE_P(Bits, CompressedGeometryBits,
                         ::testing::Values(1, 8, 14, 16, max_compressed_bits));

TEST(CompressedGeometry, NeighboursTakeLittle) {
  // A strip of small triangles along a line takes far fewer bits than 9 x 14 for three corners.
  const unsigned seed = 71;
  SCOPED_TRACE(::testing::Message() << "seed " << seed);
  RandomScene random(seed);
  CompressedGeometry strip;
  for (unsigned t = 0; t < 1000; ++t) {
    for (int k = 0; k < 3; ++k)
      strip.positions.emplace_back(float(t) / 1000 + random.real(0, 0.002f), random.real(0, 0.002f),
                                   random.real(0, 0.002f));
    strip.triangles.emplace_back(3 * t, 3 * t + 1, 3 * t + 2);
  }
  EXPECT_LT(encode_compressed_geometry(strip, 14).size(), 1000u * 9 * 14 / 8 / 2);
}

TEST(CompressedGeometry, APointAndNothingComeBack) {
  CompressedGeometry point{{glm::vec3(3, -1, 2)}, {glm::uvec3(0)}};
  const CompressedGeometry back =
      decode_compressed_geometry(encode_compressed_geometry(point, 16), 1, 1, "compressed");
  EXPECT_EQ(back.positions[0], point.positions[0]);
  EXPECT_TRUE(decode_compressed_geometry(encode_compressed_geometry({}, 16), 0, 0, "compressed")
                  .triangles.empty());
}

TEST(CompressedGeometry, HugeBoxesAreNoProblem) {
  constexpr float most = std::numeric_limits<float>::max();
  const CompressedGeometry huge{{glm::vec3(-most), glm::vec3(most), glm::vec3(0)},
                                {glm::uvec3(0, 1, 2)}};
  const CompressedGeometry back =
      decode_compressed_geometry(encode_compressed_geometry(huge, 16), 3, 1, "compressed");
  for (const glm::vec3& p : back.positions)
    for (int k = 0; k < 3; ++k) EXPECT_TRUE(std::isfinite(p[k]));
}

TEST(CompressedGeometry, RefusesWhatIsNowhere) {
  CompressedGeometry geometry = random_geometry(72, 2, false);
  geometry.positions[4].y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(encode_compressed_geometry(geometry, 16), UsageError);
}

TEST(CompressedGeometryBytes, SurviveDamage) {
  const CompressedGeometry geometry = random_geometry(73, 20, true);
  const std::size_t vertices = used_vertices(geometry.triangles);
  const auto bytes = encode_compressed_geometry(geometry, 12);
  const auto read = [&](std::span<const std::byte> b) {
    const CompressedGeometry back = decode_compressed_geometry(b, vertices, 20, "compressed");
    ASSERT_EQ(back.triangles.size(), 20u);
    ASSERT_EQ(back.positions.size(), vertices);
    for (const glm::uvec3& triangle : back.triangles)
      for (int k = 0; k < 3; ++k) ASSERT_LT(triangle[k], vertices);
  };
  const auto cut = test::survive_truncation(bytes, read);
  EXPECT_EQ(cut.read, 0u);
  const auto damaged = test::survive_damage(bytes, read);
  EXPECT_GT(damaged.refused, 0u);
}

TEST(CompressedGeometryBytes, SurviveAnything) {
  const unsigned seed = 74;
  SCOPED_TRACE(::testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  const auto read = [](std::span<const std::byte> b) {
    decode_compressed_geometry(b, 60, 30, "compressed");
  };
  test::Survival survival;
  for (int run = 0; run < 300; ++run) {
    std::vector<std::byte> bytes(random() % 600);
    for (std::byte& b : bytes) b = std::byte(random());
    test::expect_survival(bytes, read, "random bytes " + std::to_string(run), survival);
  }
  EXPECT_GT(survival.refused, 0u);
}

TEST(CompressedGeometryBytes, FewCannotAskForMuch) {
  const std::vector<std::byte> bytes(100, std::byte{1});
  EXPECT_THROW(decode_compressed_geometry(bytes, 3, std::size_t(1) << 32, "compressed"),
               InputError);
  EXPECT_THROW(decode_compressed_geometry(bytes, 1000, 30, "compressed"), InputError);
}

}  // namespace compressed_geometry_test
}  // namespace tureen
