#include "runtime/device_forecast.hpp"

#include <gtest/gtest.h>

#include "runtime/passes/texel_store.hpp"
#include "runtime/renderer.hpp"
#include "tests/support/contexts.hpp"
#include "tests/support/cutout_cloud.hpp"
#include "tests/support/random_soups.hpp"
#include "tests/support/renderer_of.hpp"

namespace tureen {
namespace device_forecast_test {

class DeviceForecastOf : public testing::TestWithParam<test::Kind> {};

TEST_P(DeviceForecastOf, IsWhatTheRendererTakesUpToPadding) {
  const gl::Context context = gl::Context::create(test::osmesa);
  for (const bool specialise : {true, false}) {
    test::SoupOptions options;
    options.kind = GetParam();
    const TriangleSoup soup = test::random_soup(17, options);
    RenderOptions render;
    render.plan.specialise = specialise;
    const Renderer renderer = renderer_of(context, soup, glm::dvec3(0), render);
    const DeviceForecast forecast = device_forecast(soup, renderer.plan().soup(0));
    // Stores of this size fill at most one layer. The padding of each is less than a row, with at
    // most 16 bytes per texel. No appearance has more than six stores.
    const auto row_bytes =
        (std::uint64_t(1) << TexelLayout::of(device_limits(context.capabilities())).row_bits) * 16;
    EXPECT_GE(renderer.device_bytes(), forecast.bytes) << "specialise " << specialise;
    EXPECT_LE(renderer.device_bytes(), forecast.bytes + 6 * row_bytes)
        << "specialise " << specialise;
    EXPECT_GT(forecast.largest_store_texels, 0u);
    EXPECT_FALSE(forecast.largest_store.empty());
  }
}

INSTANTIATE_TEST_SUITE_P(Every, DeviceForecastOf, testing::ValuesIn(test::all_kinds),
                         [](const auto& kind) { return test::to_string(kind.param); });

std::uint64_t row_texels(const gl::Context& context) {
  return std::uint64_t(1) << TexelLayout::of(device_limits(context.capabilities())).row_bits;
}

// Large enough that a wrong size of any store exceeds the padding: 2000 x 561 texels.
TEST(DeviceForecast, IsRightForManyTexels) {
  const gl::Context context = gl::Context::create(test::osmesa);
  const Scene cloud = test::cutout_cloud({.triangles = 2000, .level = 5});
  const auto& soup = only_soup(cloud);
  for (const bool specialise : {true, false}) {
    RenderOptions options;
    options.plan.specialise = specialise;
    const Renderer renderer = renderer_of(context, soup, origin_of(only_layer(cloud)), options);
    const std::uint64_t forecast = device_forecast(soup, renderer.plan().soup(0)).bytes;
    // Three stores of four bytes per texel, each padded by less than a row: 49,152 of 13 million
    // bytes, of which 5504 are used.
    const std::uint64_t padding = 3 * row_texels(context) * 4;
    EXPECT_GE(renderer.device_bytes(), forecast) << specialise;
    EXPECT_LE(renderer.device_bytes(), forecast + padding) << specialise;
  }
}

TEST(DeviceForecast, IsRightWhereFacesBetweenPixelsAreFound) {
  const gl::Context context = gl::Context::create(test::osmesa);
  const TriangleSoup soup = test::random_soup(3, {.faces = 40000});
  const Renderer renderer = renderer_of(context, soup, glm::dvec3(0));
  ASSERT_TRUE(renderer.plan().soup(0).drops_small_triangles);
  const std::uint64_t forecast = device_forecast(soup, renderer.plan().soup(0)).bytes;
  // One store of 16 bytes per texel is padded by less than a row: 32,160 of 65,536 bytes are used.
  EXPECT_GE(renderer.device_bytes(), forecast);
  EXPECT_LE(renderer.device_bytes(), forecast + row_texels(context) * 16);
}

TEST(DeviceForecast, CapacityGrowsWithWhatTheDeviceCan) {
  // 2048 columns, 512 rows, 256 layers; and twice the columns.
  EXPECT_EQ(texel_capacity({2048, 256, false}), std::uint64_t(1) << 28);
  EXPECT_EQ(texel_capacity({4096, 256, false}), std::uint64_t(1) << 29);
  EXPECT_EQ(texel_capacity({16384, 2048, false}), std::uint64_t(1) << 32);
  EXPECT_EQ(texel_capacity({16384, 8192, false}), std::uint64_t(1) << 32) << "indices have 32 bits";
}

}  // namespace device_forecast_test
}  // namespace tureen
