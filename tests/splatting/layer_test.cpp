// Splats one by one: what a layer keeps, projects and draws of a single splat, against the oracle.
#include "splatting/layer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numeric>
#include <span>

#include "oracle/oracle.hpp"
#include "scene/edit/splat_edits.hpp"
#include "splatting/tiles/tile_renderer.hpp"
#include "tests/support/random_soups.hpp"
#include "tests/support/random_splats.hpp"

namespace tureen::test {
namespace layer_test {

std::vector<std::uint32_t> indices(const Splats& splats) {
  std::vector<std::uint32_t> all(count(splats));
  std::iota(all.begin(), all.end(), 0u);
  return all;
}

class LayersOfKind : public testing::TestWithParam<SplatKind> {
 protected:
  std::unique_ptr<splatting::Layer> layer(const Splats& splats,
                                          std::span<const std::uint32_t> which) const {
    return splatting::make_layer(
        splatting::layer_data(splats, splats.profile, which, splats.color.degree));
  }
};

/// Each number of a splat is NaN in turn.
TEST_P(LayersOfKind, OmitSplatsWithANaN) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const Splats whole = random_splats(GetParam(), 3, 0.1, 1);
  EXPECT_THAT(splatting::without_nan(whole, indices(whole)), testing::ElementsAre(0u, 1u, 2u));
  std::size_t changed = 0;
  // The values of splat 1 in an array with `n` of them per splat.
  const auto spoil = [&](auto&& array_of, std::size_t n) {
    for (std::size_t k = 0; k < n; ++k) {
      Splats spoilt = whole;
      array_of(spoilt)[n + k] = nan;
      EXPECT_THAT(splatting::without_nan(spoilt, indices(spoilt)), testing::ElementsAre(0u, 2u))
          << "value " << changed;
      ++changed;
    }
  };
  const auto floats = [](auto& values) { return reinterpret_cast<float*>(values.data()); };
  spoil([&](Splats& s) { return floats(s.color.coefficients); },
        3 * coefficients_per_splat(whole.color));
  std::size_t columns = 0;
  for_each_column(whole.kernel, [&](const auto& of_whole) {
    const auto values_in = [&](Splats& s) {
      float* values = nullptr;
      std::size_t k = 0;
      for_each_column(s.kernel, [&](const auto& column) {
        if (k++ == columns) values = floats(column.values);
      });
      return values;
    };
    spoil(values_in, of_whole.of_splat(0).size());
    ++columns;
  });
}

TEST_P(LayersOfKind, ProjectTheDepthOfEachCenter) {
  const Splats splats = random_splats(GetParam(), 200, 0.05, 2);
  const Camera camera = camera_of_ball(0.5, 80, 60);
  const std::unique_ptr<splatting::Layer> all = layer(splats, indices(splats));
  ASSERT_EQ(all->count(), 200u);
  const std::span<const float> depths =
      all->project(splatting::image_view(camera, camera.eye(), 0.1, splats.profile, camera));
  std::size_t drawn = 0, omitted = 0;
  for (std::size_t i = 0; i < depths.size(); ++i) {
    const double expected = -(camera.view_from_world * glm::dvec4(center(splats, i), 1)).z;
    if (expected < double(splats.profile.min_center_depth)) {
      EXPECT_TRUE(std::isnan(depths[i])) << i;
      ++omitted;
    } else if (!std::isnan(depths[i])) {  // outside the image, or too faint
      EXPECT_NEAR(double(depths[i]), expected, 1e-5) << i;
      ++drawn;
    }
  }
  EXPECT_GT(drawn, 40u);
  EXPECT_GT(omitted, splats.profile.min_center_depth > 0 ? 20u : 0u);
}

/// Colour and alpha at every pixel, also where the oracle has none.
TEST_P(LayersOfKind, DrawASingleSplatAsTheOracle) {
  const Splats splats = random_splats(GetParam(), 60, 0.3, 3);
  const double min_alpha = double(splats.profile.min_alpha);
  const Camera camera = camera_of_ball(2.5, 45, 35);
  std::size_t covered = 0;
  for (const std::uint32_t i : indices(splats)) {
    SCOPED_TRACE(testing::Message() << "splat " << i);
    std::vector<std::uint8_t> keeps(count(splats), 0);
    keeps[i] = 1;
    Scene alone = scene_of(keep_splats(splats, keeps));
    alone.info.background = glm::vec3(0.0f);
    const OracleImage expected = render_oracle(alone, {camera}, {});
    const std::unique_ptr<splatting::Layer> one = layer(splats, std::vector<std::uint32_t>{i});
    const splatting::LayerInView view{
        one.get(), splatting::image_view(camera, camera.eye(), 1e-6, splats.profile, camera), 1.0};
    const auto in_order = [](std::size_t count, const std::function<void(std::size_t)>& body) {
      for (std::size_t k = 0; k < count; ++k) body(k);
    };
    splatting::TileRenderer(in_order).draw(
        std::span(&view, 1), {}, [&](int first_row, std::span<const float> rows) {
          for (std::size_t k = 0; k < rows.size(); k += 4) {
            const std::size_t pixel = std::size_t(first_row * camera.width) + k / 4;
            const double alpha = double(rows[k + 3]);
            const double wanted = double(expected.splat_alpha[pixel]);
            // Close to the smallest alpha, rounding decides whether there is a fragment.
            if (std::abs(std::max(alpha, wanted) - min_alpha) < 0.01 * min_alpha) continue;
            covered += wanted > 0;
            // The vectors agree with double precision to 3e-4 (docs/numerics.md).
            EXPECT_NEAR(alpha, wanted, 3e-4) << "pixel " << pixel;
            for (std::size_t channel = 0; channel < 3; ++channel)
              EXPECT_NEAR(std::clamp(double(rows[k + channel]), 0.0, 1.0),
                          double(expected.color.pixels[pixel][int(channel)]), 6e-4)
                  << "pixel " << pixel << ", channel " << channel;
          }
        });
  }
  EXPECT_GT(covered, 1000u);
}

INSTANTIATE_TEST_SUITE_P(, LayersOfKind, testing::ValuesIn(splat_kinds),
                         [](const auto& each) { return std::string(each.param.name); });

}  // namespace layer_test
}  // namespace tureen::test
