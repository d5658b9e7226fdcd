// .ksplat: values byte by byte at each level of compression, and damage.
#include "formats/splat/ksplat.hpp"

#include <algorithm>
#include <cmath>

#include "tests/formats/format_testing.hpp"
#include "tests/formats/splat/ksplat_fixture.hpp"
#include "tests/formats/splat/splat_fixture.hpp"
#include "tests/formats/truncation.hpp"

namespace tureen {
namespace ksplat_test {

using namespace test;

class Ksplat : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Level, Ksplat, ::testing::Values(0, 1, 2));

TEST_P(Ksplat, HasKnownValues) {
  const std::string bytes = two_ksplats(GetParam());
  Input input = Input::memory("a.ksplat", as_bytes(bytes));
  const Scene scene = read_ksplat(input);
  const Gaussians& g = only_gaussians(scene);
  ASSERT_EQ(g.centers.size(), 2u);
  const std::size_t first = g.centers[0].x > 0 ? 0 : 1;
  // Half a step of a box of 4 units.
  EXPECT_LT(glm::distance(g.centers[first], glm::vec3(1, 2, 3)), 1e-4f);
  EXPECT_LT(glm::distance(g.centers[1 - first], glm::vec3(-1, 0, 0.5f)), 1e-4f);
  EXPECT_EQ(g.scales[first], glm::vec3(0.5f, 0.25f, 0.125f));
  EXPECT_EQ(g.rotations[first], glm::quat(0.5f, 0.5f, -0.5f, 0.5f));
  EXPECT_NEAR(g.opacity[first], 102 / 255.0, 1e-6);
  const SplatColor& color = only_splats(scene).color;
  ASSERT_EQ(color.degree, 1);
  EXPECT_LT(glm::distance(color.coefficients[4 * first],
                          glm::vec3(0.5, -0.5, -0.3) / float(harmonics::y00)),
            1e-5f);
  for (int k = 1; k <= 3; ++k)
    for (int c = 0; c < 3; ++c)
      // Bytes have steps of 3 / 255.
      EXPECT_NEAR(color.coefficients[4 * first + std::size_t(k)][c], (k + 3 * c) / 8.0 - 1,
                  GetParam() == 2 ? 1.5 / 255 + 1e-6 : 1e-6);
}

TEST_P(Ksplat, SurvivesDamage) {
  const std::string bytes = two_ksplats(GetParam());
  const auto read = [](std::span<const std::byte> damaged) {
    Input input = Input::memory("a.ksplat", damaged);
    EXPECT_EQ(defect(only_splats(read_ksplat(input))), std::nullopt);
  };
  EXPECT_EQ(survive_truncation(as_bytes(bytes), read).read, 0u);
  survive_damage(as_bytes(bytes), read, Damage::one);
  std::string other = bytes;
  other[0] = 1;
  Input input = Input::memory("a.ksplat", as_bytes(other));
  EXPECT_THAT(error_of([&] { read_ksplat(input); }), ErrorIn("a.ksplat", "version 0.1"));
}

}  // namespace ksplat_test
}  // namespace tureen
