#include "scene/edit/splat_edits.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/random_splats.hpp"

namespace tureen {
namespace splat_edits_test {

TEST(KeepSplats, KeepsTheirDataTogether) {
  for (const test::SplatKind& kind : test::splat_kinds) {
    SCOPED_TRACE(kind.name);
    const Splats splats = test::random_splats(kind, 20, 0.1, 1);
    std::vector<std::uint8_t> keeps(20);
    keeps[3] = keeps[17] = 1;
    const Splats kept = keep_splats(splats, keeps);
    ASSERT_EQ(count(kept), 2u);
    EXPECT_EQ(defect(kept), std::nullopt);
    EXPECT_EQ(center(kept, 0), center(splats, 3));
    EXPECT_EQ(center(kept, 1), center(splats, 17));
    const std::size_t each = coefficients_per_splat(splats.color);
    for (std::size_t k = 0; k < each; ++k)
      EXPECT_EQ(kept.color.coefficients[each + k], splats.color.coefficients[17 * each + k]);
  }
}

TEST(OpaqueWindows, BecomeALayerOfTriangles) {
  Splats splats = test::random_splats(test::splat_kinds[0], 10, 0.1, 2);
  auto& windows = std::get<TriangleWindows>(splats.kernel);
  for (std::size_t i = 0; i < 10; ++i) windows.sigma[i] = i < 4 ? 0.01f : 1.0f;
  std::fill(windows.opacity.begin(), windows.opacity.end(), 0.99f);
  const Scene scene = edited(scene_of(splats), {.opaque_windows = true});
  ASSERT_EQ(scene.layers.size(), 2u);
  EXPECT_EQ(splat_count(scene), 6u);
  EXPECT_EQ(triangle_count(scene), 4u);
  // A Gaussian is never opaque.
  const Splats gaussians = test::random_splats(test::splat_kinds[1], 5, 0.1, 3);
  EXPECT_EQ(edited(scene_of(gaussians), {.opaque_windows = true}).layers.size(), 1u);
}

}  // namespace splat_edits_test
}  // namespace tureen
